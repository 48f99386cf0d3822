#!/usr/bin/env python3
"""Gives each solver the file that `--for SOLVER` writes, and runs it: the tables of docs/solvers.md.

usage: solvers.py SAGITTA DOLFINX_PYTHON|- DOCS/solvers.md|- [CASE:ORDERS...]

Curves the cases, writes each result for each solver, and lets the solver read it, in a process of its own: cells, volume, patch areas
and names are held against reference.py (relative 1e-7), which reads a text MSH 2.2 file with no reader's code. Where the solver solves,
it solves Laplace's equation with the linear function x as its answer, or takes 100 steps of Navier-Stokes. Exit code 1 where a
solver refuses a file that sagitta wrote for it, or finds something else than is there.
"""
import json
import os
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
CASES = ("weeble:23", "sphere_shell:234", "cylinder_bl:234", "torus_coarse/torus:23", "weeble_hybrid:234", "ring:234")
ENDINGS = {"mfem": "mesh", "pyfr": "msh", "dolfinx": "msh", "ngsolve": "msh", "gmsh": "msh", "paraview": "vtu", "nektar": "xml", "flexi": "h5", "su2": "su2"}
EXACT = 1e-7
# x is in the space of the nodes, so that the solution is off by what the solver's quadrature leaves of curved elements, and no more.
QUADRATURE = 1e-3


def run(*arguments, codes=(0, 3)):
    done = subprocess.run(arguments, capture_output=True, text=True)
    if done.returncode not in codes:
        sys.exit(f"{' '.join(arguments)}: {done.stdout}{done.stderr}")
    return done


def consume(sagitta, dolfinx, case, order, folder, results):
    from reference import reference

    if case == "ring":  # even hexes: PyHOPE joins the points of thin layers
        base = os.path.join(folder, case)
        run(sys.executable, os.path.join(HERE, "consume.py"), "--ring", base)
    else:
        base = os.path.join(HERE, "..", "..", "fixtures", case if "/" in case else f"{case}/{case}")
    curved, plain = os.path.join(folder, "curved.msh"), os.path.join(folder, "plain.msh")
    run(sagitta, "curve", f"{base}.msh", "--cad", f"{base}.step", "--order", order, "-o", curved, "--quiet")
    run(sagitta, "convert", curved, "-o", plain, "--msh-version", "2.2", "--ascii", "--physical-only")
    expected = reference(plain)
    for solver, ending in ENDINGS.items():
        path = os.path.join(folder, f"{solver}.{ending}")
        done = run(sagitta, "convert", curved, "--for", solver, "-o", path, codes=(0, 2))
        if done.returncode == 2:
            verdict = ("not taken", done.stderr.split("cannot be written: ")[-1].split(";")[0].split(" (the mesh")[0].strip())
        else:
            python = dolfinx if solver == "dolfinx" else sys.executable
            verdict = judge(python, solver, path, expected, order)
        results.append((case, f"P{order}", solver, *verdict))
        print(*results[-1], file=sys.stderr, flush=True)


def judge(python, solver, path, expected, order):
    """What a solver, in a process of its own, makes of a file."""
    if python == "-":
        return "not run", "not installed"
    environment = {**os.environ, "SAGITTA_ORDER": order, "OMP_NUM_THREADS": "1", "SAGITTA_PATCHES": ",".join(expected["areas"])}
    if solver == "dolfinx":
        environment["LD_LIBRARY_PATH"] = os.path.join(os.path.dirname(os.path.dirname(python)), "lib")
    try:
        done = subprocess.run([python, __file__, "--run", solver, path], capture_output=True, text=True, env=environment, timeout=900)
    except subprocess.TimeoutExpired:
        return "refused", "did not end within 900 s"
    lines = [line for line in done.stdout.splitlines() if line.startswith("{")]
    if not lines:
        return "refused", f"crashed ({done.returncode})"
    found = json.loads(lines[-1])
    if "error" in found:
        return "refused", found["error"]
    return ("wrong", "; ".join(wrong)) if (wrong := differences(found, expected)) else ("agrees", found.get("solved", "read"))


def differences(found, expected):
    wrong = []
    close = lambda a, b: abs(a - b) <= EXACT * abs(b)  # noqa: E731
    if found.get("volume") is not None and not close(found["volume"], expected["volume"]):
        wrong.append(f"volume {found['volume']:.9g} for {expected['volume']:.9g}")
    for what in ("areas", "faces"):
        if found.get(what):
            lost = set(expected[what]) ^ set(found[what])
            if lost:
                wrong.append(f"{what}: patches {sorted(lost)} on one side only")
            wrong += [f"{what} of {name}: {size:.9g} for {expected[what][name]:.9g}" for name, size in found[what].items()
                      if name in expected[what] and not close(size, expected[what][name])]
    for shape, count in (found.get("cells") or {}).items():
        if count != expected["cells"].get(shape):
            wrong.append(f"{count} {shape} for {expected['cells'].get(shape)}")
    if found.get("error_of_x", 0) > QUADRATURE:
        wrong.append(f"Laplace: x is off by {found['error_of_x']:.1e}")
    return wrong


def tables(results):
    import importlib.metadata as metadata

    orders, solvers = sorted({order for _, order, *_ in results}), list(ENDINGS)
    lines = ["| case | order | " + " | ".join(solvers) + " |", "|" + "---|" * (len(solvers) + 2)]
    for case in dict.fromkeys(case for case, *_ in results):
        for order in orders:
            row = {solver: (verdict, why) for c, o, solver, verdict, why in results if (c, o) == (case, order)}
            shown = [why if verdict == "agrees" else "-" if verdict == "not taken" else verdict for verdict, why in map(row.get, solvers)] if row else []
            lines += [f"| {case} | {order} | " + " | ".join(shown) + " |"] if row else []
    lines.append("")
    for kind in ("not taken", "not run", "refused", "wrong"):
        for reason in dict.fromkeys((solver, why) for _, _, solver, verdict, why in results if verdict == kind):
            where = [f"{case} {order}" for case, order, solver, verdict, why in results if (verdict, solver, why) == (kind, *reason)]
            lines.append(f"* {reason[0]}, {kind}: {reason[1]} ({', '.join(where)})")
    names = {"mfem": "PyMFEM", "pyfr": "PyFR", "ngsolve": "NGSolve", "gmsh": "Gmsh", "vtk": "VTK", "PyHOPE": "PyHOPE"}
    lines += ["", "Versions: " + ", ".join(f"{title} {metadata.version(name)}" for name, title in names.items()) + "."]
    return "\n".join(lines) + "\n"


def main():
    if sys.argv[1] == "--run":
        from solving import SOLVERS

        stdout = os.dup(1)
        os.dup2(2, 1)  # what solvers print goes to stderr
        try:
            found = SOLVERS[sys.argv[2]](sys.argv[3])
        except (Exception, SystemExit) as error:  # noqa: BLE001 - what the solver says is the result
            found = {"error": f"{type(error).__name__}: {error}".strip().replace("\n", " ")[:200]}
        os.write(stdout, (json.dumps(found) + "\n").encode())
        os._exit(0)
    sagitta, dolfinx, document, *cases = sys.argv[1:]
    results = []
    for case, _, orders in (text.partition(":") for text in cases or CASES):
        for order in orders or "234":
            with tempfile.TemporaryDirectory() as folder:
                consume(os.path.abspath(sagitta), dolfinx, case, order, folder, results)
    text = tables(results)
    print(text)
    if document != "-":
        with open(document) as file:
            head, rest = file.read().split("<!-- solvers -->\n")
        with open(document, "w") as file:
            file.write(f"{head}<!-- solvers -->\n{text}<!-- /solvers -->{rest.split('<!-- /solvers -->')[1]}")
    sys.exit(any(verdict in ("refused", "wrong") for *_, verdict, _ in results))


if __name__ == "__main__":
    main()
