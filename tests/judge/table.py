#!/usr/bin/env python3
"""Curves the fixtures and prints a table: our seconds, the judge's figures (it shares no code with us).

usage: table.py SAGITTA_BINARY        (from the repository's root; takes a few minutes, most of them the judge's)
"""
import json
import os
import subprocess
import sys
import tempfile
import time

CASES = [("weeble", 2), ("weeble", 3), ("weeble", 4), ("weeble_hybrid", 2), ("wing_sharp", 2), ("wing_sharp", 3),
         ("sphere_shell", 2), ("sphere_shell", 3), ("cylinder_bl", 2), ("torus", 2), ("torus", 3)]
JUDGE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "judge.py")


def row(sagitta, case, order, folder):
    stem = f"fixtures/{case}/{case}"
    curved = os.path.join(folder, f"{case}_p{order}.msh")
    start = time.time()
    done = subprocess.run([sagitta, "curve", stem + ".msh", "--cad", stem + ".step", "--linkage", stem + ".meshlink.xml",
                           "--order", str(order), "-o", curved, "--quiet"], capture_output=True)
    seconds = time.time() - start
    if done.returncode != 0:
        return f"| {case} | P{order} | exit code {done.returncode} |"
    judged = subprocess.run([sys.executable, JUDGE, stem + ".msh", curved, "--cad", stem + ".step"],
                            capture_output=True, check=True)
    r = json.loads(judged.stdout[judged.stdout.index(b"{"):])
    cells = ", ".join(f"{n} {cell}" for cell, n in r["elements"].items())
    ratio = r["boundary_dist_max"] / r["boundary_dist_baseline"]
    return (f"| {case} | P{order} | {cells} | {r['nodes']} | {r['invalid_elements']} | {r['certified']} | {r['cwcn_min']:.2f} | "
            f"{r['cjac_min']:.2f} | {r['boundary_dist_max']:.1e} ({ratio:.2f}) | {seconds:.1f} |")


def main():
    print("| case | order | cells | nodes | invalid | certified | min C_WCN | min C_JAC | wall off CAD (of Gmsh's) | seconds |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for case, order in CASES:
            print(row(sys.argv[1], case, order, folder), flush=True)


if __name__ == "__main__":
    main()
