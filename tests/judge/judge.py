#!/usr/bin/env python3
"""Independent judge of a curved mesh.

Reads the linear mesh, the curved mesh made from it and the CAD it was curved to, and prints one JSON object:

  topology_kept      same cells on the same corners          conforming   cells and boundary elements share all nodes of a face
  cjac_min, ...      J/J_c capped at 1 (paper eq. 6) on a survey of DENSITY * order divisions
  cwcn_min, ...      eqs 3-5 on the linear sub-elements (pyramids: the four base corners)
  certified          yes | no | undecided: a Bernstein bound of det J > 0 in every cell, by subdivision (plain floating point)
  boundary_dist_max  farthest point of the curved boundary from the CAD face of its entity tag; boundary_dist_baseline: the same
                     of Gmsh's own elevation (every new node projected to its entity), which ignores validity
  wall_node_dist_max farthest boundary node from its CAD face, relative to the box's diagonal

Uses none of the project's code. Distances go by entity tag: the boundary's tags must be those of the CAD's faces in file order.

usage: judge.py LINEAR.msh CURVED.msh [--cad FILE.step|.igs] [--density 4] [--json OUT] [--no-certify]
"""
import argparse, json, os, time
from math import comb, factorial
import numpy as np
import gmsh
from scipy.spatial import cKDTree

HERE = os.path.dirname(os.path.abspath(__file__))
ORDERS = json.load(open(os.path.join(HERE, "node_order.json")))["elements"]
TYPES = {e["gmsh"]["type"]: (e["shape"], e["order"], np.array(e["gmsh"]["nodes"], float) / e["order"])
         for e in ORDERS.values() if e.get("gmsh") and e["gmsh"].get("type")}
CORNERS = {"tet": 4, "hex": 8, "prism": 6, "pyramid": 5, "tri": 3, "quad": 4}
CHUNK = 1_500_000  # determinants at a time


# ---------------------------------------------------------------- element spaces, by our own monomials
def exponents(kind, p):
    r = range(p + 1)
    if kind == "tet": return [(i, j, k) for k in r for j in r for i in r if i + j + k <= p]
    if kind == "tri": return [(i, j, 0) for j in r for i in r if i + j <= p]
    if kind == "quad": return [(i, j, 0) for j in r for i in r]
    if kind == "hex": return [(i, j, k) for k in r for j in r for i in r]
    if kind == "prism": return [(i, j, k) for k in r for j in r for i in r if i + j <= p]
    if kind == "pyramid": return [(i, j, k) for i in r for j in r for k in range(p + 1 - max(i, j))]


def monomials(kind, p, x, grad=False):
    """Values (or gradients) of the element space's generators at points of the unit cell."""
    X, Y, Z = x.T
    pw = lambda b, n: np.ones_like(b) if n == 0 else b ** n
    d = lambda b, n: np.zeros_like(b) if n == 0 else n * pw(b, n - 1)
    out = []
    if kind != "pyramid":
        for i, j, k in exponents(kind, p):
            if not grad: out.append(pw(X, i) * pw(Y, j) * pw(Z, k))
            else: out.append(np.stack([d(X, i) * pw(Y, j) * pw(Z, k), pw(X, i) * d(Y, j) * pw(Z, k), pw(X, i) * pw(Y, j) * d(Z, k)], -1))
        return np.stack(out, 1)
    w = 1 - Z; apex = w < 1e-14; w = np.where(apex, 1.0, w)
    for i, j, k in exponents(kind, p):  # x^i y^j (1-z)^(max(i,j)-i-j) z^k: the rational pyramid space
        q = max(i, j) - i - j
        if not grad: out.append(np.where(apex, float(i == j == 0), X ** i * Y ** j * w ** q * Z ** k)); continue
        out.append(np.stack([d(X, i) * Y ** j * w ** q * Z ** k, X ** i * d(Y, j) * w ** q * Z ** k,
                             X ** i * Y ** j * (-q * w ** (q - 1) * Z ** k + w ** q * d(Z, k))], -1))
    return np.stack(out, 1)


_inverse = {}


def basis(kind, p, nodes, x, grad=False):
    """Lagrange functions of the given nodes at x: (points, nodes) or (points, nodes, 3)."""
    key = (kind, p, nodes.shape)
    if key not in _inverse: _inverse[key] = np.linalg.inv(monomials(kind, p, nodes))
    m = monomials(kind, p, x, grad)
    return np.einsum("pm,mn->pn", m, _inverse[key]) if not grad else np.einsum("pmd,mn->pnd", m, _inverse[key])


def lattice(kind, n):
    """Equispaced points, n divisions an edge, in the unit cell (pyramid: oblique, its singular apex left out)."""
    pts = []
    for k in range(n + 1):
        for j in range(n + 1):
            for i in range(n + 1):
                if kind == "tet" and i + j + k > n: continue
                if kind in ("prism", "tri") and i + j > n: continue
                if kind in ("tri", "quad") and k: continue
                if kind == "pyramid" and (k == n or i > n - k or j > n - k): continue
                pts.append((i / n, j / n, k / n))
    return np.array(pts)


def lattice_full(kind, n):
    L = lattice(kind, n)
    return np.vstack([L, [[0.0, 0.0, 1.0]]]) if kind == "pyramid" else L


def load(path):
    gmsh.open(path)
    ntags, xyz, _ = gmsh.model.mesh.getNodes(); o = np.argsort(ntags)
    tab = dict(tags=np.array(ntags)[o], xyz=np.array(xyz).reshape(-1, 3)[o])
    out, order = {}, 0
    for et in gmsh.model.mesh.getElementTypes(3):
        fam, p, ref = TYPES[et]; order = max(order, p)
        conn = np.array(gmsh.model.mesh.getElementsByType(et)[1]).reshape(-1, len(ref))
        out[fam] = dict(nodes=conn, ncorner=CORNERS[fam], order=p, ref=ref, x=tab["xyz"][np.searchsorted(tab["tags"], conn)])
    surf = []
    for _, tag in gmsh.model.getEntities(2):
        ets, _, nodes = gmsh.model.mesh.getElements(2, tag)
        for et, n in zip(ets, nodes):
            fam, p, ref = TYPES[et]; surf.append((tag, fam, p, ref, np.array(n).reshape(-1, len(ref))))
    return out, surf, tab, order


def dets(x, g):
    """det of x (cells, nodes, 3) against basis gradients g (points, nodes, 3)."""
    return np.linalg.det(np.einsum("enc,pnd->epcd", x, g, optimize=True))


def chunks(n, points):
    step = max(1, CHUNK // max(points, 1))
    return [slice(i, min(i + step, n)) for i in range(0, n, step)]


# ---------------------------------------------------------------- shape: linear sub-elements and their corner tets
def sub_corners(fam, n, diagonal=0):
    """Corner tetrahedra (4 lattice indices each) of the linear sub-elements of an order-n element.

    A tet's inner octahedra are cut along one of three diagonals; in a viscous layer one of them is always wrong."""
    idx = {tuple(np.round(q * n).astype(int)): i for i, q in enumerate(lattice_full(fam, n))}
    out = []
    def add(*c):
        if all(q in idx for q in c): out.append([idx[q] for q in c])
    for (i, j, k) in list(idx):
        p = lambda a, b, c: (i + a, j + b, k + c)
        if fam == "tet":
            add(p(0, 0, 0), p(1, 0, 0), p(0, 1, 0), p(0, 0, 1))
            o = [p(1, 0, 0), p(0, 1, 0), p(0, 0, 1), p(1, 1, 0), p(1, 0, 1), p(0, 1, 1)]
            if all(q in idx for q in o):
                pairs = [(0, 5), (1, 4), (2, 3)]
                d1, d2 = pairs[diagonal]
                (c1, c2), (e1, e2) = [q for q in pairs if q != (d1, d2)]
                ring = [c1, e1, c2, e2]
                for t in range(4): add(o[d1], o[d2], o[ring[t]], o[ring[(t + 1) % 4]])
            add(p(1, 1, 0), p(1, 0, 1), p(0, 1, 1), p(1, 1, 1))
        elif fam == "hex" and max(i, j, k) < n:
            for a in (0, 1):
                for b in (0, 1):
                    for c in (0, 1): add(p(a, b, c), p(1 - a, b, c), p(a, 1 - b, c), p(a, b, 1 - c))
        elif fam == "prism" and k < n:
            for tri in ([(0, 0), (1, 0), (0, 1)], [(1, 1), (0, 1), (1, 0)]):
                if not all((i + u, j + v, k) in idx for u, v in tri): continue
                for q in range(3):
                    for c in (0, 1):
                        P, Q, R = tri[q], tri[(q + 1) % 3], tri[(q + 2) % 3]
                        add(p(*P, c), p(*Q, c), p(*R, c), p(*P, 1 - c))
        elif fam == "pyramid" and i + k < n and j + k < n:
            for a in (0, 1):
                for b in (0, 1): add(p(a, b, 0), p(1 - a, b, 0), p(a, 1 - b, 0), p(0, 0, 1))
    return np.array(out, int).reshape(-1, 4)


def corner_cost(x, c, S):
    def frame(y): return np.stack([y[:, S[:, q]] - y[:, S[:, 0]] for q in (1, 2, 3)], axis=-1)
    A, W = frame(x), frame(c)
    T = A @ np.linalg.inv(W); dT = np.linalg.det(T)
    with np.errstate(all="ignore"):
        Ti = np.linalg.inv(np.where(np.abs(dT)[..., None, None] > 1e-300, T, np.eye(3)))
        k = 3.0 / (np.linalg.norm(T, axis=(-2, -1)) * np.linalg.norm(Ti, axis=(-2, -1)))
    return np.where(dT > 0, k, np.minimum(dT, 0.0))


def wcn_cost(x, c, fam, order):
    """Paper eqs 3-5 per corner tetrahedron, J taken relative to the unperturbed corner; tets: per element the cut whose worst sub-element is best."""
    best, out = np.full((len(x), 1), -np.inf), None
    for d in range(3 if fam == "tet" else 1):
        cost = corner_cost(x, c, sub_corners(fam, order, d)); worst = cost.min(1, keepdims=True)
        out = cost if out is None else np.where(worst > best, cost, out)
        best = np.maximum(best, worst)
    return out


# ---------------------------------------------------------------- certificate: Bernstein coefficients of det J, subdivided
def bern1(n):
    """1-D: Chebyshev points of (0,1) and the matrix from values there to Bernstein coefficients."""
    t = 0.5 - 0.5 * np.cos((2 * np.arange(n + 1) + 1) * np.pi / (2 * n + 2))
    return t, np.linalg.inv(np.stack([comb(n, i) * t ** i * (1 - t) ** (n - i) for i in range(n + 1)], 1))


def bern_simplex(dim, n):
    a = [(i, j, k) for i in range(n + 1) for j in range(n + 1 - i) for k in (range(n + 1 - i - j) if dim == 3 else [0])]
    pts = np.array(a, float) / max(n, 1) * (1 - 1e-3) + 1e-3 / (dim + 1) * np.array([1, 1, 1 if dim == 3 else 0])
    def val(p):
        b = [1 - p[:, :dim].sum(1)] + [p[:, q] for q in range(dim)]
        return np.stack([factorial(n) / (factorial(n - sum(e)) * np.prod([factorial(q) for q in e])) * b[0] ** (n - sum(e)) * np.prod([b[q + 1] ** e[q] for q in range(dim)], 0)
                         for e in a], 1)
    return pts[:, :dim], np.linalg.inv(val(pts))


def certificate_rule(fam, p):
    """Sample points in the parameter domain and a function from values there to Bernstein coefficients."""
    if fam == "tet":
        pts, M = bern_simplex(3, 3 * (p - 1)); return pts, lambda v: v @ M.T
    if fam == "prism":
        tri, Mt = bern_simplex(2, 3 * p - 2); t, M1 = bern1(3 * p - 1)
        pts = np.array([(*q, z) for q in tri for z in t])
        return pts, lambda v: np.einsum("eab,ca,db->ecd", v.reshape(len(v), len(tri), len(t)), Mt, M1, optimize=True).reshape(len(v), -1)
    n = (3 * p - 1,) * 3 if fam == "hex" else (3 * p - 2, 3 * p - 2, 3 * p - 3)
    T, M = zip(*[bern1(q) for q in n])
    pts = np.array([(a, b, c) for a in T[0] for b in T[1] for c in T[2]])
    return pts, lambda v: np.einsum("eabc,ia,jb,kc->eijk", v.reshape(len(v), *map(len, T)), *M, optimize=True).reshape(len(v), -1)


def children(fam):
    """Affine maps (matrix, offset) of the parameter domain onto its 8 parts."""
    h = 0.5 * np.eye(3)
    if fam == "tet":
        V = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float); m = lambda i, j: (V[i] + V[j]) / 2
        parts = [(V[i], *[m(i, j) for j in range(4) if j != i]) for i in range(4)]
        ring = [m(0, 2), m(0, 3), m(1, 3), m(1, 2)]
        parts += [(m(0, 1), m(2, 3), ring[t], ring[(t + 1) % 4]) for t in range(4)]
        return [(np.stack([b - a, c - a, d - a], 1), a) for a, b, c, d in parts]
    if fam == "prism":
        tri = [(0.5 * np.eye(2), np.array(o)) for o in ((0, 0), (.5, 0), (0, .5))] + [(-0.5 * np.eye(2), np.array((.5, .5)))]
        return [(np.block([[A, np.zeros((2, 1))], [np.zeros((1, 2)), np.array([[.5]])]]), np.array([*o, z])) for A, o in tri for z in (0, .5)]
    return [(h, np.array([a, b, c])) for a in (0, .5) for b in (0, .5) for c in (0, .5)]


def certify(fam, p, ref, x, depth=4):
    """+1 proven positive, -1 a sampled value is not positive, 0 undecided, per cell."""
    pts, to_bern = certificate_rule(fam, p); state = np.ones(len(x), int)
    todo = [(np.arange(len(x)), np.eye(3), np.zeros(3), 0)]
    while todo:
        cells, A, o, level = todo.pop()
        cells = cells[state[cells] >= 0]
        if not len(cells): continue
        q = pts @ A.T + o
        if fam == "pyramid": q = np.column_stack([q[:, 0] * (1 - q[:, 2]), q[:, 1] * (1 - q[:, 2]), q[:, 2]])
        g = basis(fam, p, ref, q, grad=True); left = []
        for s in chunks(len(cells), len(pts)):
            v = dets(x[cells[s]], g); b = to_bern(v).min(1); low = v.min(1)
            state[cells[s][low <= 0]] = -1
            left.append(cells[s][(b <= 1e-10 * np.abs(v).max(1)) & (low > 0)])
        left = np.concatenate(left)
        if not len(left): continue
        if level == depth: state[left] = 0; continue
        todo += [(left, A @ B, A @ c + o, level + 1) for B, c in children(fam)]
    return state


# ---------------------------------------------------------------- conformity
def cell_faces(fam, p, ref):
    """Index sets of a cell's faces: (corners, all nodes)."""
    i, j, k = np.round(ref * p).astype(int).T
    planes = {"tet": [i == 0, j == 0, k == 0, i + j + k == p], "hex": [i == 0, i == p, j == 0, j == p, k == 0, k == p],
              "prism": [i == 0, j == 0, i + j == p, k == 0, k == p], "pyramid": [k == 0, i == 0, j == 0, i + k == p, j + k == p]}[fam]
    for m in planes:
        n = np.where(m)[0]; yield n[n < CORNERS[fam]], n


def conformity(cells, surf):
    """Faces with the same corners must have the same nodes: between cells, and between cells and boundary elements."""
    keys, nodes, kind = {3: [], 4: []}, {3: [], 4: []}, {3: [], 4: []}
    for fam, b in cells.items():
        for c, n in cell_faces(fam, b["order"], b["ref"]):
            keys[len(c)].append(np.sort(b["nodes"][:, c], 1)); nodes[len(c)].append(np.sort(b["nodes"][:, n], 1)); kind[len(c)].append(np.zeros(len(b["nodes"]), int))
    for _, fam, p, ref, conn in surf:
        nc = CORNERS[fam]; keys[nc].append(np.sort(conn[:, :nc], 1)); nodes[nc].append(np.sort(conn, 1)); kind[nc].append(np.ones(len(conn), int))
    bad = loose = naked = 0
    for nc in (3, 4):
        if not keys[nc]: continue
        K, N, S = np.concatenate(keys[nc]), np.concatenate(nodes[nc]), np.concatenate(kind[nc]); o = np.lexsort(K.T); K, N, S = K[o], N[o], S[o]
        new = np.r_[True, (K[1:] != K[:-1]).any(1)]; group = np.cumsum(new) - 1; first = np.where(new)[0]
        bad += int((N != N[first][group]).any(1).sum())
        ncell = np.bincount(group, weights=1 - S); nsurf = np.bincount(group, weights=S)
        loose += int(((ncell == 0) & (nsurf > 0)).sum()); naked += int(((ncell == 1) & (nsurf == 0)).sum()); bad += int((ncell > 2).sum())
    return bad, loose, naked


# ---------------------------------------------------------------- distance to the CAD
def occt_faces(path):
    """The CAD's trimmed faces by tag, through OCCT itself (pip install cadquery-ocp-novtk), or nothing."""
    try:
        from OCP.STEPControl import STEPControl_Reader
        from OCP.IGESControl import IGESControl_Reader
        from OCP.TopExp import TopExp_Explorer
        from OCP.TopAbs import TopAbs_ShapeEnum
    except ImportError:
        return {}
    r = IGESControl_Reader() if path.lower().endswith((".igs", ".iges")) else STEPControl_Reader()
    r.ReadFile(path); r.TransferRoots()
    e = TopExp_Explorer(r.OneShape(), TopAbs_ShapeEnum.TopAbs_FACE); out = {}
    while e.More():
        out[len(out) + 1] = e.Current(); e.Next()
    return out


def recheck(faces, tag, pts, dist, most=600, batch=60):
    """Gmsh's closest point is a local one now and then: ask OCCT again about the farthest points until they hold."""
    if tag not in faces: return dist
    from OCP.BRepExtrema import BRepExtrema_DistShapeShape
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeVertex
    from OCP.gp import gp_Pnt
    dist = dist.copy(); known = np.zeros(len(dist), bool)
    while known.sum() < min(most, len(dist)):
        new = [i for i in np.argsort(-dist)[:batch] if not known[i]]
        if not new: break
        for i in new:
            d = BRepExtrema_DistShapeShape(BRepBuilderAPI_MakeVertex(gp_Pnt(*pts[i].tolist())).Vertex(), faces[tag])
            if d.IsDone(): dist[i] = min(dist[i], d.Value())
            known[i] = True
    return dist


def distances(surf, tab, cad, exact, most=20000):
    """Per CAD face: farthest and mean distance of the boundary elements' points, farthest of their nodes."""
    pts, nod = {}, {}
    rng = np.random.default_rng(1)
    for tag, fam, p, ref, conn in surf:
        if len(conn) > most: conn = conn[rng.choice(len(conn), most, replace=False)]
        x = tab["xyz"][np.searchsorted(tab["tags"], conn)]
        pts.setdefault(tag, []).append(np.einsum("pn,enc->epc", basis(fam, p, ref, lattice(fam, 2 * p + 1)), x).reshape(-1, 3))
        nod.setdefault(tag, []).append(np.unique(x.reshape(-1, 3), axis=0))
    gmsh.clear(); gmsh.model.occ.importShapes(cad); gmsh.model.occ.synchronize()
    known = {t for _, t in gmsh.model.getEntities(2)}; out = {}
    def dist(tag, P):
        c = np.array(gmsh.model.getClosestPoint(2, tag, P.flatten().tolist())[0]).reshape(-1, 3)
        return recheck(exact, tag, P, np.linalg.norm(c - P, axis=1))
    for tag in pts:
        if tag in known:
            d = dist(tag, np.concatenate(pts[tag])); out[tag] = [float(d.max()), float(d.mean()), float(dist(tag, np.concatenate(nod[tag])).max())]
    return out, len(pts)


def boundary(a, surf, tab, order):
    exact = occt_faces(a.cad); per, total = distances(surf, tab, a.cad, exact)
    out = {"boundary_exact": bool(exact), "boundary_faces_matched": len(per), "boundary_faces_total": total}
    if not per: return out
    diag = float(np.linalg.norm(tab["xyz"].max(0) - tab["xyz"].min(0)))
    out["boundary_dist_max"] = max(v[0] for v in per.values()); out["boundary_dist_mean"] = float(np.mean([v[1] for v in per.values()]))
    out["wall_node_dist_max"] = max(v[2] for v in per.values()) / diag; out["boundary_by_tag"] = per
    try:
        gmsh.clear(); gmsh.model.occ.importShapes(a.cad); gmsh.model.occ.synchronize(); gmsh.merge(a.linear); gmsh.model.mesh.setOrder(order)
        ntags, xyz, _ = gmsh.model.mesh.getNodes(); o = np.argsort(ntags); btab = dict(tags=np.array(ntags)[o], xyz=np.array(xyz).reshape(-1, 3)[o]); bsurf = []
        for _, tag in gmsh.model.getEntities(2):
            ets, _, nodes = gmsh.model.mesh.getElements(2, tag)
            for et, n in zip(ets, nodes):
                fam, p, ref = TYPES[et]; bsurf.append((tag, fam, p, ref, np.array(n).reshape(-1, len(ref))))
        base, _ = distances(bsurf, btab, a.cad, exact)
        out["boundary_dist_baseline"] = max(v[0] for v in base.values()); out["boundary_baseline_by_tag"] = {t: v[0] for t, v in base.items()}
    except Exception as e:
        out["boundary_baseline_error"] = str(e)
    return out


# ---------------------------------------------------------------- the verdict
def main():
    ap = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ap.add_argument("linear"); ap.add_argument("curved"); ap.add_argument("--cad"); ap.add_argument("--density", type=int, default=4)
    ap.add_argument("--json"); ap.add_argument("--no-certify", action="store_true")
    a = ap.parse_args()
    r = {"linear": os.path.basename(a.linear), "curved": os.path.basename(a.curved)}
    gmsh.initialize(); gmsh.option.setNumber("General.Terminal", 0)
    lin, _, ltab, _ = load(a.linear)
    gmsh.clear()
    cur, surf, ctab, order = load(a.curved)
    at = lambda tab, t: tab["xyz"][np.searchsorted(tab["tags"], t)]
    r["order"] = order; r["nodes"] = len(ctab["tags"])
    r["elements"] = {f: len(b["nodes"]) for f, b in cur.items()}
    r["elements_linear"] = {f: len(b["nodes"]) for f, b in lin.items()}
    r["finite"] = bool(np.isfinite(ctab["xyz"]).all())
    r["nonconforming_faces"], r["boundary_elements_off_cells"], r["bare_outer_faces"] = conformity(cur, surf)
    r["conforming"] = r["nonconforming_faces"] == 0 and r["boundary_elements_off_cells"] == 0 and r["bare_outer_faces"] == 0
    kept = r["elements"] == r["elements_linear"]
    worst = 1e300; hist = np.zeros(11, int); bad = nel = 0; cj_sum = moved = 0.0; wcn = []; proof = {1: 0, 0: 0, -1: 0}; seconds = 0.0
    for f, b in cur.items():
        if f not in lin: kept = False; continue
        lb, p = lin[f], b["order"]; survey = lattice(f, max(1, a.density * p))
        corners = b["nodes"][:, :b["ncorner"]]
        ck, lk = np.sort(corners, 1), np.sort(lb["nodes"], 1)
        if ck.shape == lk.shape and not (ck[np.lexsort(ck.T)] == lk[np.lexsort(lk.T)]).all():
            d, idx = cKDTree(ltab["xyz"]).query(at(ctab, corners.ravel()))  # tags were renumbered: match corners by position
            corners = ltab["tags"][idx].reshape(corners.shape); ck = np.sort(corners, 1)
            r["corner_match"] = "by position, max distance %.3g" % d.max()
        co, lo = np.lexsort(ck.T), np.lexsort(lk.T)
        if ck.shape != lk.shape or not (ck[co] == lk[lo]).all():
            kept = False; r["topology_note"] = f"{f}: corner connectivity differs"; continue
        x, c = b["x"][co], lb["x"][lo]; same = (corners[co] == lb["nodes"][lo]).all(1)
        if not same.all(): r["corner_order_note"] = f"{f}: corner order differs in {int((~same).sum())} cells; the mean of J_c is used there, no C_WCN"
        g, gl = basis(f, p, b["ref"], survey, grad=True), basis(f, 1, lb["ref"], survey, grad=True)
        full = lattice_full(f, p); n, nl = basis(f, p, b["ref"], full), basis(f, 1, lb["ref"], full); low = []
        for s in chunks(len(x), len(survey)):
            P, C = dets(x[s], g), dets(c[s], gl)
            C = np.where(same[s][:, None], C, C.mean(1)[:, None])
            cj = np.minimum(1.0, P / C); low.append(cj.min(1)); cj_sum += float(cj.mean(1).sum())
            r["scaled_jacobian_min"] = min(r.get("scaled_jacobian_min", 1e300), float((P.min(1) / P.max(1)).min()))
            k = same[s]
            if k.any():
                w = wcn_cost(np.einsum("pn,enc->epc", n, x[s][k]), np.einsum("pn,enc->epc", nl, c[s][k]), f, p)
                wcn.append(w.ravel().astype(np.float32)); m = r.setdefault("cwcn_min_by_cell", {}); m[f] = min(m.get(f, 1e300), float(w.min()))
        m = np.concatenate(low); worst = min(worst, float(m.min())); bad += int((m <= 0).sum()); nel += len(m)
        r.setdefault("cjac_min_by_cell", {})[f] = float(m.min())
        hist += np.histogram(np.clip(m, -0.0999, 0.99999), bins=np.linspace(-0.1, 1.0, 12))[0]
        moved = max(moved, float(np.linalg.norm(x[:, :b["ncorner"]] - at(ltab, corners[co]), axis=-1).max()))
        if not a.no_certify:
            t = time.time(); st = certify(f, p, b["ref"], x) if p > 1 else np.where(m > 0, 1, -1); seconds += time.time() - t
            for v in proof: proof[v] += int((st == v).sum())
    r["topology_kept"] = kept; r["corner_moved_max"] = moved
    if nel:
        r["cjac_min"] = worst; r["cjac_mean"] = cj_sum / nel; r["invalid_elements"] = bad; r["cjac_hist_below_0_then_tenths"] = hist.tolist()
    if wcn:
        w = np.concatenate(wcn); r["cwcn_min"] = float(w.min()); r["cwcn_mean"] = float(w.mean(dtype=float)); r["cwcn_share_below_0.8"] = float((w < 0.8).mean())
    if not a.no_certify and nel:
        r["certified"] = "no" if proof[-1] or not kept else "undecided" if proof[0] else "yes"
        r["certified_counts"] = {"valid": proof[1], "undecided": proof[0], "invalid": proof[-1]}; r["certify_s"] = seconds
    if a.cad: r.update(boundary(a, surf, ctab, order))
    gmsh.finalize()
    s = json.dumps(r, indent=1); print(s)
    if a.json: open(a.json, "w").write(s)


if __name__ == "__main__":
    main()
