#!/usr/bin/env python3
"""Makes viscous meshes on every CAD file of some folders, curves them, and prints a table.

usage: gauntlet_3d.py SAGITTA DIR[:DIR] [--orders 2,3] [--cells prism,tet] [--only NAME,...] [--seconds 120] [--out FOLDER]
                      [--no-peer]

The meshes are those of fixtures/make_foreign.py, with the options in OPTIONS where a file needs some (walls among the faces, sizes), and
as many cells as TARGET says. "off" are faces that had to leave the CAD, with their nodes' largest distance; "open" those of which it could
not be decided where they lie, with the first cause. "Gmsh" is the number of elements that are invalid after Gmsh's own elevation
of the same mesh, as `sagitta check` finds; a dash where Gmsh has no such mesh. A mesh that is there already is taken as it is.
"""
import argparse
import json
import os
import resource
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
MAKE = os.path.join(HERE, "..", "..", "fixtures", "make_foreign.py")
PEER = os.path.join(HERE, "..", "judge", "peer_gmsh.py")
CAD = (".stp", ".step", ".igs", ".iges", ".brep", ".egads")
TARGET = "30000"
OPTIONS = {
    "3d_bl_wing.stp": ["--faces", "1-4"],
    "D150WithGuides_fusedAircraft.brep": ["--sagitta-over-h0", "200", "--target", "60000"],
    "dlr_f6.brep": ["--faces", "1-123", "--target", "60000"],
    "onera-m6-sharp-te.stp": ["--faces", "3-12", "--sagitta-over-h0", "200"],
    "onera-m6-sharp-te.egads": ["--faces", "3-12", "--sagitta-over-h0", "200"],
    "mach_onera_m6.igs": ["--sew", "1e-8", "--weld", "2e-4", "--size", "0.055", "--size-min", "0.003"],
    "IEA_15MW_CFD.stp": ["--faces", "2,3", "--size", "3.2", "--size-min", "0.45", "--curvature", "9"],
    "IEA_15MW_CFD.igs": ["--faces", "1,2", "--size", "3.2", "--size-min", "0.45", "--curvature", "9"],
    "mesh_T106_V3.step": ["--faces", "1,2"],
    "propeller_and_shaft.iges": ["--size", "20", "--size-min", "1.6", "--curvature", "8", "--layers", "10", "--tries", "1"],
}
HEAD = "| CAD | cells | order | exit | off | open | C_WCN | C_JAC | J/Jc | CPU s | Gmsh |"


def files(folders):
    """CAD files of folders and their sub-folders, by path."""
    found = []
    for folder in folders.split(":"):
        for place, _, names in os.walk(folder):
            found += [os.path.join(place, name) for name in names if name.lower().endswith(CAD)]
    return sorted(found)


def cpu():
    """CPU seconds of the commands that have ended: a busy machine does not change them much."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def run(command, seconds):
    """Exit code, output and CPU seconds of a command; no exit code where it took too long."""
    start = cpu()
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=seconds)
    except subprocess.TimeoutExpired:
        return None, "", cpu() - start
    return done.returncode, done.stdout + done.stderr, cpu() - start


def mesh_of(path, cells, out):
    """The mesh on a CAD file, or why there is none."""
    name = os.path.basename(path).replace(".", "_") + "_" + cells
    mesh = os.path.join(out, name + ".msh")
    if not os.path.exists(mesh):
        options = OPTIONS.get(os.path.basename(path), [])
        target = [] if "--target" in options or "--size" in options else ["--target", TARGET]
        command = [sys.executable, MAKE, path, "--outdir", out, "--name", name, "--cells", cells] + options + target
        code, text, _ = run(command, 600)
        if code != 0 or not os.path.exists(mesh):
            lines = [line for line in text.strip().split("\n") if line]
            return None, (lines[-1] if lines else "took longer than 600 s")[:80]
    return mesh, None


def peer(sagitta, mesh, path, order, out):
    """Invalid elements after Gmsh's elevation."""
    curved = os.path.join(out, "peer.msh")
    code, _, _ = run([sys.executable, PEER, mesh, path, str(order), "none", curved], 300)
    report = os.path.join(out, "peer.json")
    if code != 0 or run([sagitta, "check", curved, "--report", report], 300)[0] not in (0, 4):
        return "-"
    with open(report) as text:
        return str(sum(kind["invalid"] for kind in json.load(text)["cells"]))


def row(sagitta, mesh, path, order, out, seconds):
    """Exit code, faces off and open, minima, CPU seconds."""
    curved, report = (os.path.join(out, "curved." + kind) for kind in ("msh", "json"))
    if os.path.exists(report):
        os.remove(report)
    command = [sagitta, "curve", mesh, "--cad", path, "--order", str(order), "-q", "-o", curved, "--report", report]
    code, text, took = run(command + ["--time-limit", str(seconds)], 10 * seconds)
    if not os.path.exists(report):
        return [str(code), text.strip().split("\n")[-1][:80], "-", "-", "-", "-", f"{took:.0f}"]
    with open(report) as text:
        told = json.load(text)
    off, left = told["off_cad"], told["open_faces"]
    far = max((face["node_distance"] or 0 for face in off), default=0)
    end = told["smoothing"]["end"]
    bound = told["certificate"]["j_over_jc"]["lower"]
    return [
        str(code),
        f"{len(off)}, {far:.1e}" if off else "0",
        f"{len(left)}: {left[0]['cause'][:60]}" if left else "0",
        f"{end['c_wcn']:.3f}",
        f"{end['c_jac']:.3f}",
        "-" if bound is None else f"{bound:.3f}",
        f"{took:.0f}",
    ]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sagitta")
    parser.add_argument("folders")
    parser.add_argument("--orders", default="2,3")
    parser.add_argument("--cells", default="prism,tet")
    parser.add_argument("--only", default="")
    parser.add_argument("--seconds", type=int, default=120)
    parser.add_argument("--out", default="target/gauntlet")
    parser.add_argument("--no-peer", action="store_true")
    asked = parser.parse_args()
    os.makedirs(asked.out, exist_ok=True)
    print(HEAD + "\n" + "|---" * HEAD.count(" | ") + "|---|", flush=True)
    for path in files(asked.folders):
        name = os.path.basename(path)
        if asked.only and not any(part in name for part in asked.only.split(",")):
            continue
        for cells in asked.cells.split(","):
            mesh, cause = mesh_of(path, cells, asked.out)
            if mesh is None:
                print(f"| {name} | {cells} | no mesh: {cause} |", flush=True)
                continue
            for order in map(int, asked.orders.split(",")):
                figures = row(os.path.abspath(asked.sagitta), mesh, path, order, asked.out, asked.seconds)
                other = "-" if asked.no_peer else peer(os.path.abspath(asked.sagitta), mesh, path, order, asked.out)
                print("| " + " | ".join([name, cells, f"P{order}"] + figures + [other]) + " |", flush=True)


if __name__ == "__main__":
    main()
