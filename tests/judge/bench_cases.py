#!/usr/bin/env python3
"""Curves every case in a folder, has the result judged by code that is not ours, and prints a table.

usage: bench_cases.py SAGITTA CASES [--orders 2,3,4] [--only NAME,...] [--iges] [--peer] [--methods NAME,...]
                      [--certify] [--out FOLDER]

CASES holds a folder a case, each with one NAME.msh, NAME.step (NAME.igs) and NAME.meshlink.xml, as fixtures/make_cases.py
writes them. `good` is the judge's verdict: topology kept, conforming, no invalid element at density
4p, wall no farther from the CAD than 1.2 times Gmsh's interpolation, wall nodes on the CAD, exit code 0, nothing
off the CAD. The certificate is ours (exit code 0 says that it holds); --certify lets the judge prove it too, in Python.
--peer curves the same meshes with Gmsh's own methods (at most 300 s each), or with those named.
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
PEER = ["none", "optimize", "elastic", "elastic_optimize", "fast"]
HEAD = "| case | order | by | elements | nodes | good | invalid | C_WCN | C_JAC | wall / Gmsh's | seconds | peak MB |"


def timed(command, timeout=None):
    """Runs a command; its exit code (None after the timeout), seconds and peak memory in MB."""
    start = time.time()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    peak = 0
    while process.poll() is None:
        peak = max(peak, resident(process.pid))
        if timeout and time.time() - start > timeout:
            process.kill()
            process.wait()
            return None, time.time() - start, peak
        time.sleep(0.02)
    return process.returncode, time.time() - start, peak


def resident(pid):
    """Most memory that a process had resident so far, MB."""
    try:
        with open(f"/proc/{pid}/status") as status:
            return next((int(line.split()[1]) for line in status if line.startswith("VmHWM")), 0) / 1024
    except OSError:
        return 0


def judge(linear, curved, cad, certify):
    command = [sys.executable, os.path.join(HERE, "judge.py"), linear, curved, "--cad", cad]
    done = subprocess.run(command + ([] if certify else ["--no-certify"]), capture_output=True)
    if b"{" not in done.stdout:
        return None
    return json.loads(done.stdout[done.stdout.index(b"{"):])


BASELINES = {}


def baseline(case, order, judged):
    """How far from the CAD Gmsh's own interpolation of the walls is; Gmsh cannot interpolate on some IGES files, and the shape is
    that of the STEP file, which was judged before."""
    return BASELINES.setdefault((case, order), judged.get("boundary_dist_baseline", float("nan")))


def row(case, order, by, code, seconds, peak, judged, off_cad):
    if judged is None:
        return f"| {case} | P{order} | {by} | | | no | exit {code} | | | | {seconds:.1f} | {peak:.0f} |"
    near = judged["boundary_dist_max"] / baseline(case, order, judged)
    good = (judged["topology_kept"] and judged["conforming"] and judged["invalid_elements"] == 0 and near <= 1.2
            and judged["wall_node_dist_max"] <= 1e-9 and code == 0 and not off_cad
            and judged.get("certified") in (True, None))
    cells = ", ".join(f"{n} {cell}" for cell, n in judged["elements"].items())
    return (f"| {case} | P{order} | {by} | {cells} | {judged['nodes']} | {'yes' if good else 'no'} | "
            f"{judged['invalid_elements']} | {judged['cwcn_min']:.3f} | {judged['cjac_min']:.3f} | {near:.2f} | "
            f"{seconds:.1f} | {peak:.0f} |")


def ours(options, case, stem, order, cad, folder):
    curved = os.path.join(folder, f"{case}_p{order}.msh")
    report = os.path.join(folder, f"{case}_p{order}.json")
    command = [options.sagitta, "curve", stem + ".msh", "--cad", cad, "--order", str(order), "-o", curved, "--report",
               report, "--quiet"]
    if cad.endswith(".step"):
        command += ["--linkage", stem + ".meshlink.xml"]
    code, seconds, peak = timed(command)
    judged = judge(stem + ".msh", curved, cad, options.certify) if code in (0, 3) else None
    by = "sagitta" if cad.endswith(".step") else "sagitta, IGES"
    return row(case, order, by, code, seconds, peak, judged, code == 3)


def peer(case, stem, order, method, folder):
    curved = os.path.join(folder, f"{case}_p{order}_{method}.msh")
    command = [sys.executable, os.path.join(HERE, "peer_gmsh.py"), stem + ".msh", stem + ".step", str(order), method, curved]
    code, seconds, peak = timed(command, 300)
    judged = judge(stem + ".msh", curved, stem + ".step", False) if code == 0 else None
    return row(case, order, f"Gmsh {method}", "over 300 s" if code is None else code, seconds, peak, judged, False)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sagitta")
    parser.add_argument("cases")
    parser.add_argument("--orders", default="2,3,4")
    parser.add_argument("--only", default="")
    parser.add_argument("--iges", action="store_true")
    parser.add_argument("--peer", action="store_true")
    parser.add_argument("--methods", default=",".join(PEER))
    parser.add_argument("--certify", action="store_true")
    parser.add_argument("--out", help="keep the curved meshes and reports here")
    options = parser.parse_args()
    only = [name for name in options.only.split(",") if name]
    with tempfile.TemporaryDirectory() as scratch:
        folder = options.out or scratch
        os.makedirs(folder, exist_ok=True)
        print(HEAD + "\n" + "|---" * HEAD.count(" |") + "|", flush=True)
        for mesh in sorted(glob.glob(os.path.join(options.cases, "*", "*.msh"))):
            stem, case = mesh[:-4], os.path.basename(os.path.dirname(mesh))
            if (only and case not in only) or not os.path.exists(stem + ".step"):
                continue
            for order in map(int, options.orders.split(",")):
                print(ours(options, case, stem, order, stem + ".step", folder), flush=True)
                if options.iges and os.path.exists(stem + ".igs"):
                    print(ours(options, case, stem, order, stem + ".igs", folder), flush=True)
                for method in options.methods.split(",") if options.peer else []:
                    print(peer(case, stem, order, method, folder), flush=True)


if __name__ == "__main__":
    main()
