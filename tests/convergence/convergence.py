#!/usr/bin/env python3
"""Potential flow past a cylinder on half rings of hexes, each twice as fine as the one before: `make convergence`.

usage: convergence.py SAGITTA DOCS/convergence.md PICTURE.png

Each ring is curved by sagitta to the order of the solution and given to MFEM, beside the same ring with straight edges. The answer is
known: phi = x (1 + a^2 / r^2); it stands on the far field, and the wall and the planes of symmetry are natural. Writes the errors, their
observed orders and the picture; exit code 1 where an order on curved meshes is not k + 1 to 0.3, or that on straight ones above 2.5.
"""
import math
import os
import subprocess
import sys
import tempfile

RADIUS, FAR, THICKNESS = 0.5, 10.0, 1.0
LEVELS = ((8, 10, 1.35), (16, 20, 1.162), (32, 40, 1.078))  # elements round and out, growth outward
ORDERS = (2, 3, 4)
CLOSE = 0.3


def ring(base, level):
    """Half a ring in hexes, one layer thick."""
    import gmsh

    around, outward, growth = LEVELS[level]
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("Mesh.Binary", 1)
    occ, mesh, model = gmsh.model.occ, gmsh.model.mesh, gmsh.model
    whole = [(3, occ.addCylinder(0, 0, 0, 0, 0, THICKNESS, radius, angle=math.pi)) for radius in (FAR, RADIUS)]
    occ.cut(whole[:1], whole[1:])
    occ.synchronize()
    gmsh.write(f"{base}.step")
    radius = lambda point: math.hypot(*model.getValue(0, point, [])[:2])  # noqa: E731
    height = lambda point: model.getValue(0, point, [])[2]  # noqa: E731
    for _, curve in model.getEntities(1):
        a, b = (point for _, point in model.getBoundary([(1, curve)], oriented=False))
        if abs(radius(a) - radius(b)) > 1:
            mesh.setTransfiniteCurve(curve, outward + 1, "Progression", growth if radius(a) < radius(b) else 1 / growth)
        else:
            mesh.setTransfiniteCurve(curve, 2 if abs(height(a) - height(b)) > THICKNESS / 2 else around + 1)
    groups = {}
    for _, face in model.getEntities(2):
        mesh.setTransfiniteSurface(face)
        mesh.setRecombine(2, face)
        edges = model.getBoundary([(2, face)], oriented=False, recursive=True)
        is_round = model.getType(2, face) != "Plane"
        name = ("wall" if max(radius(point) for _, point in edges) < 1 else "farfield") if is_round else "symmetry"
        groups.setdefault(name, []).append(face)
    volumes = [volume for _, volume in model.getEntities(3)]
    for volume in volumes:
        mesh.setTransfiniteVolume(volume)
    for name, faces in groups.items():
        model.addPhysicalGroup(2, faces, name=name)
    model.addPhysicalGroup(3, volumes, name="fluid")
    mesh.generate(3)
    gmsh.write(f"{base}.msh")
    os._exit(0)


def solve(path, order):
    """Error of the potential in L2 and of the wall pressure, both relative; and how many unknowns."""
    import mfem.ser as mfem
    import numpy as np

    mesh = mfem.Mesh(path, 1, 1)
    attribute = {name: mesh.bdr_attribute_sets.GetAttributeSet(name).ToList()[0] for name in mesh.bdr_attribute_sets.GetAttributeSetNames()}
    space = mfem.FiniteElementSpace(mesh, mfem.H1_FECollection(order, 3))

    class Potential(mfem.PyCoefficient):
        def EvalValue(self, x):
            return x[0] * (1 + RADIUS**2 / (x[0] ** 2 + x[1] ** 2))

    solution, fixed = mfem.GridFunction(space), mfem.intArray()
    solution.Assign(0.0)
    far = mfem.intArray([int(n + 1 == attribute["farfield"]) for n in range(mesh.bdr_attributes.Max())])
    solution.ProjectBdrCoefficient(Potential(), far)
    space.GetEssentialTrueDofs(far, fixed)
    form, right = mfem.BilinearForm(space), mfem.LinearForm(space)
    form.AddDomainIntegrator(mfem.DiffusionIntegrator(mfem.ConstantCoefficient(1.0)))
    form.Assemble()
    right.Assemble()
    operator, b, x = mfem.OperatorPtr(), mfem.Vector(), mfem.Vector()
    form.FormLinearSystem(fixed, solution, right, operator, x, b)
    matrix = mfem.OperatorHandle2SparseMatrix(operator)
    mfem.PCG(matrix, mfem.GSSmoother(matrix), b, x, 0, 20000, 1e-28, 0.0)
    form.RecoverFEMSolution(x, right, solution)
    square, area = 0.0, 0.0
    for n in range(mesh.GetNBE()):
        if mesh.GetBdrAttribute(n) != attribute["wall"]:
            continue
        face = mesh.GetBdrFaceTransformations(n)
        rule, slope, normal = mfem.IntRules.Get(face.GetGeometryType(), 2 * order + 4), mfem.Vector(3), mfem.Vector(3)
        for k in range(rule.GetNPoints()):
            point = rule.IntPoint(k)
            face.SetAllIntPoints(point)
            solution.GetGradient(face.GetElement1Transformation(), slope)
            mfem.CalcOrtho(face.Jacobian(), normal)
            at, speed, size = face.Transform(point), np.array(slope.GetDataArray()), np.linalg.norm(normal.GetDataArray())
            angle = math.atan2(at[1], at[0])
            square += point.weight * size * (1 - speed @ speed - (1 - 4 * math.sin(angle) ** 2)) ** 2
            area += point.weight * size
    return solution.ComputeL2Error(Potential()), math.sqrt(square / area), matrix.Height()


def run(*arguments):
    done = subprocess.run(arguments, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(arguments)}: {done.stdout}{done.stderr}")


def study(sagitta):
    """Errors by (order of the solution, whether curved), level by level."""
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        for level in range(len(LEVELS)):
            base = os.path.join(folder, f"ring{level}")
            run(sys.executable, __file__, "--ring", base, str(level))
            straight = f"{base}_p1.mesh"
            run(sagitta, "convert", f"{base}.msh", "--for", "mfem", "-o", straight)
            for order in ORDERS:
                curved = f"{base}_p{order}.mesh"
                run(sagitta, "curve", f"{base}.msh", "--cad", f"{base}.step", "--order", str(order), "--for", "mfem", "-o", curved, "--quiet")
                for path in (straight, curved):
                    found.setdefault((order, path is curved), []).append(solve(path, order))
                    print(order, level, path is curved, found[order, path is curved][-1], file=sys.stderr, flush=True)
    return found


def orders(errors):
    return [math.log2(before / after) for before, after in zip(errors, errors[1:])]


def table(found):
    lines = ["| k | mesh | " + " | ".join(f"{a} x {o}" for a, o, _ in LEVELS) + " | order | wall pressure | order |",
             "|" + "---|" * (len(LEVELS) + 5)]
    for (order, curved), rows in found.items():
        potential, wall = [row[0] for row in rows], [row[1] for row in rows]
        told = lambda values: ", ".join(f"{value:.1f}" for value in orders(values))  # noqa: E731
        lines.append(f"| {order} | {f'P{order}' if curved else 'straight'} | " + " | ".join(f"{value:.2e}" for value in potential)
                     + f" | {told(potential)} | {', '.join(f'{value:.1e}' for value in wall)} | {told(wall)} |")
    return "\n".join(lines) + "\n"


def picture(found, path):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(6.4, 4.4))
    sizes = [1 / around for around, _, _ in LEVELS]
    for color, order in zip(("tab:blue", "tab:orange", "tab:green"), ORDERS):
        for curved, style in ((False, "--s"), (True, "-o")):
            errors = [row[0] for row in found[order, curved]]
            axes.loglog(sizes, errors, style, color=color, label=f"k = {order}, " + (f"curved P{order}" if curved else "straight"))
    axes.set_xlabel("element size (1 / elements round the half cylinder)")
    axes.set_ylabel("error of the potential, L2")
    axes.grid(True, which="both", alpha=0.3)
    axes.legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(path, dpi=110)


def main():
    if sys.argv[1] == "--ring":
        ring(sys.argv[2], int(sys.argv[3]))
    sagitta, document, drawn = sys.argv[1:]
    found = study(os.path.abspath(sagitta))
    picture(found, drawn)
    with open(document) as file:
        head, rest = file.read().split("<!-- convergence -->\n")
        tail = rest.split("<!-- /convergence -->")[1]
    with open(document, "w") as file:
        file.write(f"{head}<!-- convergence -->\n{table(found)}<!-- /convergence -->{tail}")
    last = {key: orders([row[0] for row in rows])[-1] for key, rows in found.items()}
    bad = [f"k = {k}, {'curved' if curved else 'straight'}: {order:.2f}" for (k, curved), order in last.items()
           if (abs(order - k - 1) > CLOSE if curved else order > 2.5)]
    print(table(found))
    sys.exit("\n".join(bad) or None)


if __name__ == "__main__":
    main()
