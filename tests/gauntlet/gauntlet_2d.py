#!/usr/bin/env python3
"""Makes viscous meshes round random airfoils, curves each at P2, P3 and P4, and tells what came out.

usage: gauntlet_2d.py SAGITTA [--count 200] [--seed 1] [--orders 2,3,4] [--out FOLDER] [--judge] [--seconds 60]

The meshes are those of `fixtures/make_2d.py --gauntlet`: airfoils of the AeroSandbox wheel, with random cells, points, first cells and
aspect ratios; those that are in FOLDER already are taken as they are. A run is good if it ends with exit code 0: every element certified,
every wall on the CAD. Exceptions are listed, and runs whose C_JAC is below 0.6; with --judge also what tests/judge/judge_2d.py finds.
"""
import argparse
import glob
import json
import os
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
MAKE = os.path.join(HERE, "..", "..", "fixtures", "make_2d.py")
JUDGE = os.path.join(HERE, "..", "judge", "judge_2d.py")
FLOOR = 0.6


def made(options):
    """The linear meshes in the folder, made where there are none."""
    meshes = os.path.join(options.out, "*.msh")
    if not glob.glob(meshes):
        command = [sys.executable, MAKE, "--gauntlet", str(options.count), "--seed", str(options.seed), "--outdir", options.out]
        subprocess.run(command, check=True)
    return sorted(glob.glob(meshes))[: options.count]


def curve(options, mesh, order, folder):
    """What came of one run: exit code, smallest C_WCN and C_JAC, seconds, and what there is to say."""
    output, report = (os.path.join(folder, name) for name in ("out.msh", "report.json"))
    command = [options.sagitta, "curve", mesh, "--cad", mesh[:-4] + ".step", "--order", str(order), "-o", output, "--report", report, "-q"]
    start = time.time()
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=options.seconds)
    except subprocess.TimeoutExpired:
        return None, 0.0, 0.0, time.time() - start, f"not done in {options.seconds} s"
    seconds = time.time() - start
    if done.returncode not in (0, 3, 5):
        told = done.stderr.strip().splitlines()
        return done.returncode, 0.0, 0.0, seconds, told[-1] if told else ""
    cells = json.load(open(report))["cells"]
    wcn, jac = (min(cell[key] for cell in cells) for key in ("c_wcn_min", "c_jac_min"))
    told = judged(mesh, output, order) if options.judge and done.returncode == 0 else ""
    return done.returncode, wcn, jac, seconds, told


def judged(mesh, output, order):
    """What the judge does not like."""
    command = [sys.executable, JUDGE, mesh, output, "--cad", mesh[:-4] + ".step", "--quiet", "--json", output + ".json"]
    subprocess.run(command, capture_output=True)
    found = json.load(open(output + ".json"))
    faults = [key for key in ("invalid_elements", "nonconforming_faces", "bare_outer_faces", "boundary_folded", "out_of_plane") if found[key]]
    faults += [key for key in ("topology_kept", "conforming", "boundary_kept") if not found[key]]
    faults += ["certified"] if found["certified"] != "yes" else []
    faults += ["off the CAD"] if found["wall_node_dist_max_abs"] > 1e-9 else []
    limit = 1.001 if order == 2 else 0.7
    times = found["boundary_dist_max"] / found["boundary_dist_baseline"]
    faults += [f"{times:.2f} x Gmsh's distance"] if times > limit else []
    return ", ".join(faults)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sagitta")
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--orders", default="2,3,4")
    parser.add_argument("--out", default=os.path.join(tempfile.gettempdir(), "sagitta-gauntlet-2d"))
    parser.add_argument("--judge", action="store_true")
    parser.add_argument("--seconds", type=float, default=60.0)
    options = parser.parse_args()
    os.makedirs(options.out, exist_ok=True)
    meshes, rows = made(options), {}
    with tempfile.TemporaryDirectory() as folder:
        for mesh in meshes:
            for order in map(int, options.orders.split(",")):
                code, wcn, jac, seconds, told = curve(options, mesh, order, folder)
                rows.setdefault(order, []).append((code, wcn, jac, seconds))
                if code != 0 or jac < FLOOR or told:
                    print(f"{os.path.basename(mesh)} P{order}: exit {code}, C_WCN {wcn:.3f}, C_JAC {jac:.3f} {told}", flush=True)
    print("\n| order | runs | exit 0 | C_JAC < 0.6 | least C_WCN | least C_JAC | mean seconds |")
    print("|---|---|---|---|---|---|---|")
    for order, runs in sorted(rows.items()):
        good = [run for run in runs if run[0] == 0]
        low, least = sum(run[2] < FLOOR for run in good), [min((run[k] for run in good), default=0.0) for k in (1, 2)]
        mean = sum(run[3] for run in runs) / len(runs)
        print(f"| P{order} | {len(runs)} | {len(good)} | {low} | {least[0]:.3f} | {least[1]:.3f} | {mean:.2f} |")


if __name__ == "__main__":
    main()
