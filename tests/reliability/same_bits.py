#!/usr/bin/env python3
"""Two builds of sagitta, one optimised and one hardly, write the same bytes: Rust's arithmetic leaves them no choice.

    same_bits.py OPTIMISED PLAIN

Curves the small fixtures with both at P2, P3 and P4 and compares the meshes. Ends with 1 where two differ. (rustc 1.95 once compiled the
Hessian of the shape term wrongly, so that smoothing took other steps; no test of the mesh's quality saw it.)
"""

import argparse
import filecmp
import subprocess
import sys
import tempfile
from pathlib import Path

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"
# One of each kind of cell and of boundary; by the folder's name.
CASES = ["weeble", "weeble_hybrid", "torus_coarse", "sphere_shell", "cylinder_bl_coarse", "periodic", "sheet", "cascade", "naca0012_sharp"]
SWEEPS = "10"


def mesh_and_cad(case):
    """The mesh and the CAD in a fixture's folder."""
    folder = FIXTURES / case
    meshes = [m for m in sorted(folder.glob("*.msh")) if "_p" not in m.stem]
    return meshes[0], sorted(folder.glob("*.step"))[0]


def curved(program, case, order, out):
    """The file that a program writes of a fixture."""
    mesh, cad = mesh_and_cad(case)
    command = [program, "curve", mesh, "--cad", cad, "--order", str(order), "--max-sweeps", SWEEPS, "-o", out]
    done = subprocess.run(command, capture_output=True, text=True)
    if not out.exists():
        sys.exit(f"{program} wrote nothing of {mesh} at P{order} (exit code {done.returncode}):\n{done.stderr[-2000:]}")
    return out


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("optimised", type=Path)
    parser.add_argument("plain", type=Path)
    programs = vars(parser.parse_args())
    other = 0
    with tempfile.TemporaryDirectory() as folder:
        for case in CASES:
            for order in (2, 3, 4):
                files = [curved(program, case, order, Path(folder) / f"{name}_{case}_{order}.msh") for name, program in programs.items()]
                same = filecmp.cmp(*files, shallow=False)
                other += not same
                print(f"{case:20} P{order}  {'the same' if same else 'DIFFERENT'}", flush=True)
    sys.exit(f"{other} meshes differ" if other else 0)


if __name__ == "__main__":
    main()
