#!/usr/bin/env python3
"""Feeds curved meshes to the programs that take them, and compares what they find: `make consumers`.

usage: consume.py SAGITTA [CASE:ORDERS...] > table

Curves the cases, writes each result in every format, and gives the files to the readers of readers.py, each in a process of its
own. Volumes, areas and counts are held against reference.py, which reads the text MSH 2.2 file with no reader's code. Prints the
table that stands in tests/consumers/README.md; exit code 1 where a reader, not known to be at fault, finds something else than is there.
"""
import json
import math
import os
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

HERE = os.path.dirname(os.path.abspath(__file__))
FIXTURES = os.path.join(HERE, "..", "..", "fixtures")
CASES = ("sphere_shell:234", "cylinder_bl:234", "weeble_hybrid:234", "periodic/sector:234", "ring:234")
FORMATS = {"msh41b": ("msh", []), "msh41a": ("msh", ["--ascii"]), "msh22b": ("msh", ["--msh-version", "2.2"]),
           "msh22a": ("msh", ["--msh-version", "2.2", "--ascii"]), "cgns": ("cgns", []), "vtu": ("vtu", []), "vtu_volume": ("vtu", ["--volume-only"])}
TITLES = {"msh41b": "MSH 4.1", "msh41a": "MSH 4.1 ASCII", "msh22b": "MSH 2.2", "msh22a": "MSH 2.2 ASCII", "cgns": "CGNS", "vtu": "VTU",
          "vtu_volume": "VTU --volume-only"}
# What a reader is known to read wrong; tests/consumers/README.md has the evidence.
FAULTY = {("VTK", "cgns", "periodic/sector P4")}
EXACT = 1e-7  # relative; the readers' quadratures differ


def run(*arguments):
    done = subprocess.run(arguments, capture_output=True, text=True)
    if done.returncode not in (0, 3):
        sys.exit(f"{' '.join(arguments)}: {done.stdout}{done.stderr}")
    return done.stdout


def differences(found, expected, names):
    """What a reader found otherwise; and what it could not tell."""
    wrong, untold = [], []
    close = lambda a, b, bar: abs(a - b) <= bar * abs(b)  # noqa: E731
    if found["volume"] is None:
        untold.append("volume")
    elif not close(found["volume"], expected["volume"], EXACT):
        wrong.append(f"volume {found['volume']:.9g} for {expected['volume']:.9g}")
    for shape, n in found["cells"].items():
        if n != expected["cells"].get(shape):
            wrong.append(f"{n} {shape} for {expected['cells'].get(shape)}")
    if not found["areas"]:
        untold.append("areas")
    for which, bar in (("areas", EXACT), ("faces", 0)):
        for key, size in found[which].items():
            name = names.get(key, key)
            if name not in expected[which] or not close(size, expected[which][name], bar):
                wrong.append(f"{which} of {name}: {size:.9g} for {expected[which].get(name)}")
    if not found["faces"]:
        untold.append("patches")
    return wrong, untold


def as_vtu(expected):
    """What a VTU file of this mesh holds: pyramids as degenerate hexes, as VTK has no others beyond the linear ones."""
    cells = dict(expected["cells"])
    cells["hex"] = cells.get("hex", 0) + cells.pop("pyramid", 0)
    return {**expected, "cells": cells}


def consume(sagitta, case, order, folder, results):
    curved = os.path.join(folder, "curved.msh")
    base, linear = os.path.join(folder, "ring"), os.path.join(folder, "linear.msh")
    if case == "ring":
        run(sys.executable, __file__, "--ring", base)
    else:
        base = os.path.join(FIXTURES, case if "/" in case else f"{case}/{case}")
    run(sys.executable, __file__, "--name-cells", f"{base}.msh", linear)
    run(sagitta, "curve", linear, "--cad", f"{base}.step", "--order", order, "-o", curved, "--quiet")
    files = {}
    for key, (ending, options) in FORMATS.items():
        files[key] = os.path.join(folder, f"{key}.{ending}")
        run(sagitta, "convert", curved, "-o", files[key], *options)
    sys.path.insert(0, HERE)
    from readers import READERS
    from reference import parse, reference

    expected = reference(files["msh22a"])
    names = {f"#{tag}": name for (dimension, tag), name in parse(files["msh22a"])[0].items() if dimension == 2}
    patches = ",".join(name for (dimension, _), name in parse(files["msh22a"])[0].items() if dimension == 2)
    environment = {**os.environ, "SAGITTA_ORDER": order, "SAGITTA_NAMES": patches}
    pairs = [(reader, key) for reader, (_, formats) in READERS.items() for key in formats]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        outcomes = pool.map(lambda pair: outcome(pair[0], files[pair[1]], environment), pairs)
    for (reader, key), found in zip(pairs, outcomes):
        if "error" in found:
            verdict = ("refused", found["error"].replace(folder + "/", ""))
        else:
            wrong, untold = differences(found, as_vtu(expected) if key.startswith("vtu") else expected, names)
            verdict = ("wrong", "; ".join(wrong)) if wrong else ("agrees", ", ".join(untold))
        results.setdefault((reader, key), []).append((f"{case} P{order}", *verdict))
        print(f"{case} P{order} {reader} {key}: {verdict}", file=sys.stderr)


def outcome(reader, path, environment):
    """What a reader, in a process of its own, says of a file."""
    try:
        done = subprocess.run([sys.executable, __file__, "--read", reader, path], capture_output=True, text=True, env=environment, timeout=900)
        return json.loads(done.stdout.splitlines()[-1]) if done.stdout.strip() else {"error": f"crashed ({done.returncode})"}
    except subprocess.TimeoutExpired:
        return {"error": "did not end within 900 s"}
    except json.JSONDecodeError:
        return {"error": f"crashed ({done.returncode})"}


def read(reader, path):
    sys.path.insert(0, HERE)
    from readers import READERS

    stdout = os.dup(1)
    os.dup2(2, 1)  # what readers print goes to stderr
    try:
        found = READERS[reader][0](path)
    except (Exception, SystemExit) as error:  # noqa: BLE001 - what the reader says is the result
        found = {"error": f"{type(error).__name__}: {error}".strip().replace("\n", " ")[:200]}
    os.write(stdout, (json.dumps(found) + "\n").encode())
    os._exit(0)  # some readers crash at the end only


def name_cells(path, out):
    """Leaves out the elements of no group (points, curves), over which MFEM and meshio stumble, and calls the cells' group fluid, as
    PyFR wants it."""
    import gmsh

    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("Mesh.Binary", 1)
    gmsh.open(path)
    gmsh.model.removePhysicalGroups(gmsh.model.getPhysicalGroups(3))
    gmsh.model.addPhysicalGroup(3, [tag for _, tag in gmsh.model.getEntities(3)], 1000, "fluid")
    gmsh.write(out)
    os._exit(0)


def ring(base):
    """A quarter of a ring in hexes of even thickness: PyHOPE joins the points of thin layers."""
    import gmsh

    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("Mesh.Binary", 1)
    occ, mesh = gmsh.model.occ, gmsh.model.mesh
    occ.addRectangle(1, 0, 0, 1, 1)
    occ.revolve([(2, 1)], 0, 0, 0, 0, 1, 0, math.pi / 2, numElements=[5], recombine=True)
    occ.synchronize()
    for _, curve in gmsh.model.getBoundary([(2, 1)], oriented=False):
        mesh.setTransfiniteCurve(curve, 4)
    mesh.setTransfiniteSurface(1)
    mesh.setRecombine(2, 1)
    groups = {}
    for _, face in gmsh.model.getEntities(2):
        x, _, z = gmsh.model.occ.getCenterOfMass(2, face)
        is_round = gmsh.model.getType(2, face) == "Cylinder"
        groups.setdefault(("wall" if math.hypot(x, z) < 1 else "farfield") if is_round else "symmetry", []).append(face)
    for name, faces in groups.items():
        gmsh.model.addPhysicalGroup(2, faces, name=name)
    gmsh.model.addPhysicalGroup(3, [tag for _, tag in gmsh.model.getEntities(3)], name="fluid")
    mesh.generate(3)
    gmsh.write(f"{base}.msh")
    gmsh.write(f"{base}.step")
    os._exit(0)


def main():
    if sys.argv[1] == "--read":
        read(*sys.argv[2:])
    if sys.argv[1] == "--name-cells":
        name_cells(*sys.argv[2:])
    if sys.argv[1] == "--ring":
        ring(sys.argv[2])
    sagitta, *cases = sys.argv[1:]
    results = {}
    for case, _, orders in (text.partition(":") for text in cases or CASES):
        for order in orders or "234":
            with tempfile.TemporaryDirectory() as folder:
                consume(os.path.abspath(sagitta), case, order, folder, results)
    table(results)
    wrong = {(*pair, what) for pair, verdicts in results.items() for what, verdict, _ in verdicts if verdict == "wrong"}
    sys.exit(bool(wrong - FAULTY))


def table(results):
    print("| reader | file | agrees | does not, and why |\n|---|---|---|---|")
    for (reader, key), verdicts in results.items():
        agreed = [what for what, verdict, _ in verdicts if verdict == "agrees"]
        untold = {why for _, verdict, why in verdicts if verdict == "agrees" and why}
        told = f" (does not tell {' / '.join(sorted(untold))})" if untold else ""
        others = {}
        for what, verdict, why in verdicts:
            if verdict != "agrees":
                others.setdefault((verdict, why), []).append(what)
        reasons = "; ".join(f"{', '.join(what)}: {verdict}: {why}" for (verdict, why), what in others.items()).replace("|", "/")
        print(f"| {reader} | {TITLES[key]} | {len(agreed)} of {len(verdicts)}{told} | {reasons} |")


if __name__ == "__main__":
    main()
