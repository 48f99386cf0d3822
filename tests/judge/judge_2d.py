#!/usr/bin/env python3
"""Independent judge of a curved mesh in the plane z = 0.

Reads the linear mesh, the curved mesh made from it and the CAD it was curved to, and prints one JSON object:

  topology_kept      same cells on the same corners          conforming   cells and boundary lines share all nodes of an edge
  cjac_min, ...      J/J_c capped at 1 on a survey of DENSITY * order divisions; invalid_elements: J <= 0 there
  cwcn_min, ...      2 / (|T| |T^-1|) of the linear sub-elements, the straight sub-element as target; det T where that is not positive
  certified          yes | no | undecided: Bernstein coefficients of det J (triangles degree 2p-2, quads 2p-1 each way), by subdivision
  boundary_dist_max  farthest point of the boundary lines from the CAD curve of their entity tag; boundary_dist_baseline: the same of
                     Gmsh's plain elevation of the linear mesh; cad_dist_max: farthest point of those CAD curves from the mesh's
  wall_node_dist_max farthest boundary node from its CAD curve, relative to the box's diagonal (.._abs: as it is)
  boundary_folded    boundary lines that run back along their CAD curve
  periodic_dist_max  pairs of the linear file's $Periodic: how far the curved nodes of one are from the other's image
  peer               Gmsh's setOrder(p) alone on the same mesh: its invalid elements, by the same survey

Uses none of the project's code. Distances go by entity tag: the curves' tags must be those of the CAD's edges in file order (TopExp).

usage: judge_2d.py LINEAR.msh CURVED.msh [--cad FILE.step] [--density 4] [--json OUT] [--no-certify] [--no-peer] [--quiet]
       judge_2d.py LINEAR.msh --peer-only P --cad FILE.step [-o OUT.msh]      Gmsh's plain elevation, judged
       judge_2d.py --self-test                                                a ring curved by formula, and the same with faults
"""
import argparse, json, os, tempfile, time
from math import comb, factorial
import numpy as np
import gmsh
from scipy.spatial import cKDTree

HERE = os.path.dirname(os.path.abspath(__file__))
ORDERS = json.load(open(os.path.join(HERE, "node_order.json")))["elements"]
DIM = {"line": 1, "tri": 2, "quad": 2}
TYPES = {e["gmsh"]["type"]: (e["shape"], e["order"], np.array(e["gmsh"]["nodes"], float)[:, :DIM[e["shape"]]] / e["order"])
         for e in ORDERS.values() if e["shape"] in DIM and e.get("gmsh") and e["gmsh"].get("type")}
GMSH = {(f, p): t for t, (f, p, _) in TYPES.items()}
CORNERS = {"tri": 3, "quad": 4}
CHUNK = 2_000_000


# ---------------------------------------------------------------- element spaces
def exponents(kind, p):
    r = range(p + 1)
    return [(i, 0) for i in r] if kind == "line" else [(i, j) for j in r for i in r if kind == "quad" or i + j <= p]


def basis(kind, p, nodes, x, grad=False):
    """Lagrange functions of the given nodes at x: (points, nodes) or (points, nodes, 2)."""
    pad = lambda v: np.column_stack([v, np.zeros(len(v))]) if v.shape[1] == 1 else v
    ex = exponents(kind, p); pw = lambda b, n: np.ones_like(b) if n == 0 else b ** n; d = lambda b, n: np.zeros_like(b) if n == 0 else n * pw(b, n - 1)
    val = lambda v: np.stack([pw(v[:, 0], i) * pw(v[:, 1], j) for i, j in ex], 1)
    inv = np.linalg.inv(val(pad(nodes))); x = pad(np.asarray(x, float))
    if not grad: return val(x) @ inv
    g = np.stack([np.stack([d(x[:, 0], i) * pw(x[:, 1], j), pw(x[:, 0], i) * d(x[:, 1], j)], -1) for i, j in ex], 1)
    return np.einsum("pmd,mn->pnd", g, inv)


def lattice(kind, n):
    if kind == "line": return np.linspace(0, 1, n + 1)[:, None]
    return np.array([(i / n, j / n) for j in range(n + 1) for i in range(n + 1) if kind == "quad" or i + j <= n])


def dets(x, g):
    a = np.einsum("enc,pnd->epcd", x, g, optimize=True)
    return a[..., 0, 0] * a[..., 1, 1] - a[..., 0, 1] * a[..., 1, 0]


def chunks(n, points):
    step = max(1, CHUNK // max(points, 1)); return [slice(i, min(i + step, n)) for i in range(0, n, step)]


def collect():
    """Cells by kind, boundary lines (tag, order, ref, nodes), node table of the model that Gmsh holds."""
    tags, xyz, _ = gmsh.model.mesh.getNodes(); o = np.argsort(tags); tab = dict(tags=np.array(tags)[o], xyz=np.array(xyz).reshape(-1, 3)[o]); out, order, lines = {}, 0, []
    for et in gmsh.model.mesh.getElementTypes(2):
        fam, p, ref = TYPES[et]; order = max(order, p); conn = np.array(gmsh.model.mesh.getElementsByType(et)[1]).reshape(-1, len(ref))
        if fam in out: raise SystemExit("cells of one shape in two orders")
        out[fam] = dict(nodes=conn, order=p, ref=ref, x=tab["xyz"][np.searchsorted(tab["tags"], conn)][..., :2])
    for _, t in gmsh.model.getEntities(1):
        ets, _, nodes = gmsh.model.mesh.getElements(1, t)
        for et, n in zip(ets, nodes): fam, p, ref = TYPES[et]; lines.append((t, p, ref, np.array(n).reshape(-1, len(ref))))
    return out, lines, tab, order


def load(path):
    gmsh.clear(); gmsh.open(path); r = collect(); per = []
    for d, t in gmsh.model.getEntities(1):
        m, n, nm, aff = gmsh.model.mesh.getPeriodicNodes(1, t)
        if m != t and len(n): per.append((t, m, np.array(aff).reshape(4, 4)))
    return (*r, per)


# ---------------------------------------------------------------- shape
def sub_corners(fam, n):
    """Corner triples (lattice indices) of the linear sub-elements."""
    idx = {tuple(np.round(q * n).astype(int)): i for i, q in enumerate(lattice(fam, n))}; out = []
    for i, j in idx:
        if fam == "tri":
            for t in ([(i, j), (i + 1, j), (i, j + 1)], [(i + 1, j + 1), (i, j + 1), (i + 1, j)]):
                if all(q in idx for q in t): out.append([idx[q] for q in t])
        elif max(i, j) < n:
            for a in (0, 1):
                for b in (0, 1):
                    q, u, v = (i + a, j + b), (i + 1 - a, j + b), (i + a, j + 1 - b); out.append([idx[z] for z in ((q, u, v) if a == b else (q, v, u))])
    return np.array(out, int)


def wcn_cost(x, c, fam, order):
    S = sub_corners(fam, order); frame = lambda y: np.stack([y[:, S[:, 1]] - y[:, S[:, 0]], y[:, S[:, 2]] - y[:, S[:, 0]]], -1)
    T = frame(x) @ np.linalg.inv(frame(c)); d = T[..., 0, 0] * T[..., 1, 1] - T[..., 0, 1] * T[..., 1, 0]
    return np.where(d > 0, 2 * d / np.maximum((T ** 2).sum((-1, -2)), 1e-300), np.minimum(d, 0.0))  # |T^-1| = |T| / det T in 2D


# ---------------------------------------------------------------- certificate
def certificate_rule(fam, p):
    """Sample points and the matrix from values there to Bernstein coefficients of det J."""
    if fam == "tri":
        n = 2 * (p - 1); a = [(i, j) for i in range(n + 1) for j in range(n + 1 - i)]; pts = np.array(a, float) / max(n, 1) * (1 - 1e-3) + 1e-3 / 3
        V = np.stack([factorial(n) / (factorial(i) * factorial(j) * factorial(n - i - j)) * pts[:, 0] ** i * pts[:, 1] ** j * (1 - pts.sum(1)) ** (n - i - j) for i, j in a], 1)
        return pts, np.linalg.inv(V)
    n = 2 * p - 1; t = 0.5 - 0.5 * np.cos((2 * np.arange(n + 1) + 1) * np.pi / (2 * n + 2)); M = np.linalg.inv(np.stack([comb(n, i) * t ** i * (1 - t) ** (n - i) for i in range(n + 1)], 1))
    return np.array([(u, v) for u in t for v in t]), np.kron(M, M)


def certify(fam, p, ref, x, depth=7):
    """+1 proven positive, -1 a sampled value is not positive, 0 undecided, per cell."""
    pts, M = certificate_rule(fam, p); state = np.ones(len(x), int); todo = [(np.arange(len(x)), np.eye(2), np.zeros(2), 0)]
    h = 0.5 * np.eye(2); kids = [(h, np.array(o)) for o in ((0, 0), (.5, 0), (0, .5))] + [(-h, np.array((.5, .5))) if fam == "tri" else (h, np.array((.5, .5)))]
    while todo:
        cells, A, o, level = todo.pop(); cells = cells[state[cells] >= 0]
        if not len(cells): continue
        g = basis(fam, p, ref, pts @ A.T + o, grad=True); left = []
        for s in chunks(len(cells), len(pts)):
            v = dets(x[cells[s]], g); b = (v @ M.T).min(1); low = v.min(1); state[cells[s][low <= 0]] = -1
            left.append(cells[s][(b <= 1e-11 * np.abs(v).max(1)) & (low > 0)])
        left = np.concatenate(left)
        if not len(left): continue
        if level == depth: state[left] = 0; continue
        todo += [(left, A @ B, A @ c + o, level + 1) for B, c in kids]
    return state


# ---------------------------------------------------------------- conformity
def conformity(cells, lines):
    """Edges with the same corners must have the same nodes: (bad edges, lines without a cell, outer edges without a line)."""
    by = {}
    for fam, b in cells.items():
        p = b["order"]; i, j = np.round(b["ref"] * p).astype(int).T
        for m in ([i == 0, j == 0, i + j == p] if fam == "tri" else [i == 0, i == p, j == 0, j == p]):
            n = np.where(m)[0]; c = n[n < CORNERS[fam]]
            for row in b["nodes"]: by.setdefault(tuple(sorted(row[c].tolist())), []).append((0, tuple(sorted(row[n].tolist()))))
    for _, p, ref, conn in lines:
        for row in conn: by.setdefault(tuple(sorted(row[:2].tolist())), []).append((1, tuple(sorted(row.tolist()))))
    bad = loose = naked = 0
    for l in by.values():
        nc = sum(k == 0 for k, _ in l); ns = len(l) - nc; bad += len({s for _, s in l}) > 1 or nc > 2; loose += nc == 0; naked += nc == 1 and ns == 0
    return int(bad), int(loose), int(naked)


# ---------------------------------------------------------------- distance to the CAD
class Curve:
    """A CAD curve: samples and Newton, on Gmsh's values and derivatives (OCC's)."""
    def __init__(self, tag, m=4001):
        self.tag = tag; lo, hi = gmsh.model.getParametrizationBounds(1, tag); self.a, self.b = lo[0], hi[0]; self.t = np.linspace(self.a, self.b, m); self.x = self.value(self.t)
        self.closed = np.linalg.norm(self.x[0] - self.x[-1]) < 1e-9 * np.ptp(self.x, axis=0).max(); self.tree = cKDTree(self.x)

    def value(self, t): return np.array(gmsh.model.getValue(1, self.tag, np.asarray(t).tolist())).reshape(-1, 3)

    def foot(self, P):
        """Distances and parameters of the closest points."""
        k = self.tree.query(P, k=4)[1]; best = np.full(len(P), np.inf); at = np.zeros(len(P)); h = self.t[1] - self.t[0]
        for c in range(4):
            t0 = self.t[k[:, c]]; t = t0.copy()
            for _ in range(8):
                l = t.tolist(); r = self.value(t) - P; d1 = np.array(gmsh.model.getDerivative(1, self.tag, l)).reshape(-1, 3); d2 = np.array(gmsh.model.getSecondDerivative(1, self.tag, l)).reshape(-1, 3)
                f, df = (r * d1).sum(1), (d1 * d1).sum(1) + (r * d2).sum(1); t = np.clip(t - f / np.where(df > 0, df, (d1 * d1).sum(1)), np.maximum(t0 - 2 * h, self.a), np.minimum(t0 + 2 * h, self.b))
            for u in (t, t0):
                d = np.linalg.norm(self.value(u) - P, axis=1); w = d < best; best[w] = d[w]; at[w] = u[w]
        return best, at


def cad_curves(path):
    gmsh.clear(); gmsh.model.occ.importShapes(path); gmsh.model.occ.synchronize(); return {t: Curve(t) for _, t in gmsh.model.getEntities(1)}


def covered(Y, lines, tab, m=16):
    """Farthest of the points from the mesh's lines: nearest of m chords a line, then Gauss-Newton on the line's polynomial."""
    best = np.full(len(Y), np.inf)
    for p, ref in {(l[1], len(l[2])): l[1:3] for l in lines}.values():
        x = np.concatenate([tab["xyz"][np.searchsorted(tab["tags"], l[3])] for l in lines if l[1] == p]); s = np.einsum("pn,enc->epc", basis("line", p, ref, lattice("line", m)), x)
        mid = 0.5 * (s[:, 1:] + s[:, :-1]).reshape(-1, 3); near = cKDTree(mid).query(Y, k=min(4, len(mid)))[1].reshape(len(Y), -1)
        for k in near.T:
            e, u = k // m, (k % m + 0.5) / m
            for step in range(8):
                r = np.einsum("pn,pnc->pc", basis("line", p, ref, u[:, None]), x[e]) - Y; best = np.minimum(best, np.linalg.norm(r, axis=1))
                g = np.einsum("pn,pnc->pc", basis("line", p, ref, u[:, None], grad=True)[..., 0], x[e]); u = np.clip(u - (r * g).sum(1) / np.maximum((g * g).sum(1), 1e-300), 0, 1)
    return float(best.max())


def distances(lines, tab, curves, cover=True):
    """Per CAD curve: farthest and mean distance of the lines' points, of their nodes, of the CAD from the lines; folded lines."""
    out, folded = {}, 0
    for tag in sorted({l[0] for l in lines}):
        if tag not in curves: continue
        C, P, N = curves[tag], [], []
        for t, p, ref, conn in lines:
            if t != tag: continue
            x = tab["xyz"][np.searchsorted(tab["tags"], conn)]; ev = lambda n: np.einsum("pn,enc->epc", basis("line", p, ref, lattice("line", n)), x)
            s = ev(4 * p + 3); P.append(s.reshape(-1, 3)); N.append(x.reshape(-1, 3))
            d, at = C.foot(P[-1]); at = at.reshape(len(s), -1); dt = np.diff(at, axis=1)
            if C.closed: L = C.b - C.a; dt = (dt + L / 2) % L - L / 2
            tol = 1e-7 * (C.b - C.a); folded += int(((dt > tol).any(1) & (dt < -tol).any(1)).sum())
        d = C.foot(np.concatenate(P))[0]; dn = C.foot(np.concatenate(N))[0]; row = [float(d.max()), float(d.mean()), float(dn.max())]
        if cover: row.append(covered(C.x, [l for l in lines if l[0] == tag], tab))
        out[tag] = row
    return out, folded


def plain(linear, cad, order, out=None):
    """Gmsh's elevation alone: every new node of a curve projected to it, nothing else moved."""
    gmsh.clear(); gmsh.model.occ.importShapes(cad); gmsh.model.occ.synchronize(); gmsh.merge(linear); gmsh.model.mesh.setOrder(order)
    if out: gmsh.option.setNumber("Mesh.SaveAll", 1); gmsh.option.setNumber("Mesh.Binary", 1); gmsh.write(out)
    return collect()


def survey(cells, density):
    """Per kind: least J and least / greatest of every cell on the survey."""
    r = {}
    for f, b in cells.items():
        g = basis(f, b["order"], b["ref"], lattice(f, max(1, density * b["order"])), grad=True); r[f] = np.concatenate([dets(b["x"][s], g).min(1) for s in chunks(len(b["x"]), len(g))])
    return r


# ---------------------------------------------------------------- the verdict
def judge(linear, curved, cad=None, density=4, certified=True, peer=True):
    r = {"linear": os.path.basename(linear), "curved": os.path.basename(curved)}
    lin, llines, ltab, _, periodic = load(linear); cur, lines, ctab, order, _ = load(curved); at = lambda tab, t: tab["xyz"][np.searchsorted(tab["tags"], t)][..., :2]
    r["order"] = order; r["nodes"] = len(ctab["tags"]); r["elements"] = {f: len(b["nodes"]) for f, b in cur.items()}; r["elements_linear"] = {f: len(b["nodes"]) for f, b in lin.items()}
    r["finite"] = bool(np.isfinite(ctab["xyz"]).all()); r["out_of_plane"] = float(np.abs(ctab["xyz"][:, 2]).max())
    r["nonconforming_faces"], r["boundary_elements_off_cells"], r["bare_outer_faces"] = conformity(cur, lines)
    r["conforming"] = r["nonconforming_faces"] == 0 and r["boundary_elements_off_cells"] == 0 and r["bare_outer_faces"] == 0
    turned = sum(int((d <= 0).sum()) for d in survey(lin, 1).values()); r["linear_not_positive"] = turned
    kept = r["elements"] == r["elements_linear"] and len({b["order"] for b in cur.values()}) == 1
    # boundary lines: same corners on the same tags
    ends = lambda L, pos: {t: sorted(tuple(sorted(map(tuple, np.round(q, 9).tolist()))) if pos else tuple(sorted(q.tolist())) for l in L if l[0] == t for q in (l[3][:, :2] if not pos else pos(l[3][:, :2]))) for t in {l[0] for l in L}}
    r["boundary_kept"] = ends(llines, None) == ends(lines, None) or {t: len(v) for t, v in ends(llines, None).items()} == {t: len(v) for t, v in ends(lines, None).items()}
    # a file with its nodes renumbered: cell k of the one is cell k of the other, if that pairs the corners one to one; else by position
    pairs = [np.stack([cur[f]["nodes"][:, :CORNERS[f]].ravel(), lin[f]["nodes"].ravel()], 1) for f in cur if f in lin and len(cur[f]["nodes"]) == len(lin[f]["nodes"])]
    pairs = np.unique(np.concatenate(pairs), axis=0) if pairs and kept else np.zeros((0, 2), int); one = len(pairs) and len(np.unique(pairs[:, 0])) == len(np.unique(pairs[:, 1])) == len(pairs)
    worst = 1e300; hist = np.zeros(11, int); bad = nel = 0; total = moved = 0.0; wcn, badlist = [], []; proof = {1: 0, 0: 0, -1: 0}; seconds = 0.0
    for f, b in cur.items():
        if f not in lin: kept = False; continue
        lb, p, nc = lin[f], b["order"], CORNERS[f]; corners = b["nodes"][:, :nc]; ck, lk = np.sort(corners, 1), np.sort(lb["nodes"], 1)
        if ck.shape == lk.shape and not (ck[np.lexsort(ck.T)] == lk[np.lexsort(lk.T)]).all():
            if one: corners = pairs[np.searchsorted(pairs[:, 0], corners), 1]; ck = np.sort(corners, 1); r["corner_match"] = "by the order of the cells"
        if not one and ck.shape == lk.shape and not (ck[np.lexsort(ck.T)] == lk[np.lexsort(lk.T)]).all():
            d, idx = cKDTree(ltab["xyz"]).query(np.column_stack([at(ctab, corners.ravel()), np.zeros(corners.size)])); corners = ltab["tags"][idx].reshape(corners.shape); ck = np.sort(corners, 1)  # renumbered: by position
            r["corner_match"] = "by position, max distance %.3g" % d.max()
        co, lo = np.lexsort(ck.T), np.lexsort(lk.T)
        if ck.shape != lk.shape or not (ck[co] == lk[lo]).all(): kept = False; r["topology_note"] = f"{f}: corner connectivity differs"; continue
        x, c = b["x"][co], lb["x"][lo]; same = (corners[co] == lb["nodes"][lo]).all(1)
        if not same.all(): r["corner_order_note"] = f"{f}: corner order differs in {int((~same).sum())} cells; the mean of |J_c| is used there, no C_WCN"
        pts = lattice(f, max(1, density * p)); g, gl = basis(f, p, b["ref"], pts, grad=True), basis(f, 1, lb["ref"], pts, grad=True)
        full = lattice(f, p); n, nl = basis(f, p, b["ref"], full), basis(f, 1, lb["ref"], full); low = []
        for s in chunks(len(x), len(pts)):
            P, C = dets(x[s], g), dets(c[s], gl); C = np.where(same[s][:, None], C, np.abs(C.mean(1))[:, None]); C = np.where(C == 0, 1e-300, C)
            neg = C.max(1) < 0; cj = np.minimum(1.0, np.where(neg[:, None], P / -C, P / C)); low.append(cj.min(1)); total += float(cj.mean(1).sum())
            r["scaled_jacobian_min"] = min(r.get("scaled_jacobian_min", 1e300), float((P.min(1) / np.abs(P).max(1)).min())); k = same[s] & ~neg
            if k.any():
                w = wcn_cost(np.einsum("pn,enc->epc", n, x[s][k]), np.einsum("pn,enc->epc", nl, c[s][k]), f, p); wcn.append(w.ravel().astype(np.float32)); m = r.setdefault("cwcn_min_by_cell", {}); m[f] = min(m.get(f, 1e300), float(w.min()))
        m = np.concatenate(low); worst = min(worst, float(m.min())); bad += int((m <= 0).sum()); nel += len(m); r.setdefault("cjac_min_by_cell", {})[f] = float(m.min()); r.setdefault("invalid_by_cell", {})[f] = int((m <= 0).sum())
        badlist += [(float(m[k]), f, *np.round(c[k].mean(0), 6).tolist()) for k in np.argsort(m)[:3]]; hist += np.histogram(np.clip(m, -0.0999, 0.99999), bins=np.linspace(-0.1, 1.0, 12))[0]
        moved = max(moved, float(np.linalg.norm(x[:, :nc] - at(ltab, corners[co]), axis=-1).max()))
        if certified:
            t = time.time(); st = certify(f, p, b["ref"], x) if p > 1 or f == "quad" else np.where(m > 0, 1, -1); seconds += time.time() - t
            for v in proof: proof[v] += int((st == v).sum())
    r["topology_kept"] = bool(kept); r["corner_moved_max"] = moved
    if nel: r.update(cjac_min=worst, cjac_mean=total / nel, invalid_elements=bad, cjac_hist_below_0_then_tenths=hist.tolist(), worst_cells=[dict(cjac=q[0], cell=q[1], at=q[2:]) for q in sorted(badlist)[:3]])
    if wcn: w = np.concatenate(wcn); r["cwcn_min"] = float(w.min()); r["cwcn_mean"] = float(w.mean(dtype=float)); r["cwcn_share_below_0.8"] = float((w < 0.8).mean())
    if certified and nel:
        r["certified"] = "no" if proof[-1] or not kept else "undecided" if proof[0] else "yes"; r["certified_counts"] = {"valid": proof[1], "undecided": proof[0], "invalid": proof[-1]}; r["certify_s"] = seconds
    if periodic:
        far = 0.0
        for t, m, aff in periodic:
            get = lambda tag: ctab["xyz"][np.searchsorted(ctab["tags"], np.unique(np.concatenate([l[3].ravel() for l in lines if l[0] == tag])))]
            S, Mx = get(t), get(m); img = Mx @ aff[:3, :3].T + aff[:3, 3]
            if len(S) != len(img): far = float("inf"); break
            far = max(far, float(cKDTree(img).query(S)[0].max()), float(cKDTree(S).query(img)[0].max()))
        r["periodic_dist_max"] = far
    if cad:
        curves = cad_curves(cad); per, folded = distances(lines, ctab, curves); r["boundary_faces_matched"] = len(per); r["boundary_faces_total"] = len({l[0] for l in lines}); r["cad_curves"] = len(curves)
        if per:
            diag = float(np.linalg.norm(np.ptp(ctab["xyz"], axis=0))); node = max(v[2] for v in per.values())
            r.update(boundary_dist_max=max(v[0] for v in per.values()), boundary_dist_mean=float(np.mean([v[1] for v in per.values()])), wall_node_dist_max=node / diag, wall_node_dist_max_abs=node,
                     cad_dist_max=max(v[3] for v in per.values()), boundary_folded=folded, boundary_by_tag=per)
        if peer and order > 1:
            try:
                pc, pl, pt, _ = plain(linear, cad, order); sv = survey(pc, density); r["peer"] = {"program": "Gmsh setOrder", "invalid_elements": sum(int((v <= 0).sum()) for v in sv.values()), "invalid_by_cell": {f: int((v <= 0).sum()) for f, v in sv.items()}}
                curves = cad_curves(cad); base, _ = distances(pl, pt, curves, cover=False); r["boundary_dist_baseline"] = max(v[0] for v in base.values()); r["boundary_baseline_by_tag"] = {t: v[0] for t, v in base.items()}
                for t in base:
                    if t in per: r["boundary_worse_than_baseline_max"] = max(r.get("boundary_worse_than_baseline_max", -1e300), per[t][0] - base[t][0])
            except Exception as e: r["boundary_baseline_error"] = str(e)
    return r


# ---------------------------------------------------------------- self-test
def write_mesh(path, X, cells, lines, p):
    """MSH through Gmsh: cells {fam: nodes}, closed lines {tag: nodes} that begin at CAD vertex tag; nodes from 1."""
    gmsh.clear(); gmsh.model.add("t"); owner = np.zeros(len(X) + 1, int); Y = np.column_stack([X, np.zeros(len(X))])
    for t, c in lines.items():
        gmsh.model.addDiscreteEntity(0, t); gmsh.model.addDiscreteEntity(1, t, [t, t]); owner[c] = t; owner[c[0, 0]] = -t
    gmsh.model.addDiscreteEntity(2, 1, list(lines)); k = 1
    def put(d, t, v): gmsh.model.mesh.addNodes(d, t, v.tolist(), Y[v - 1].ravel())
    for t, c in lines.items():
        put(0, t, c[0, :1]); put(1, t, np.where(owner == t)[0]); gmsh.model.mesh.addElements(0, t, [15], [[k]], [[int(c[0, 0])]]); k += 1
    put(2, 1, np.where(owner == 0)[0][1:])
    for t, c in lines.items(): gmsh.model.mesh.addElementsByType(t, GMSH["line", p], list(range(k, k + len(c))), c.ravel()); k += len(c)
    for f, c in cells.items(): gmsh.model.mesh.addElementsByType(1, GMSH[f, p], list(range(k, k + len(c))), c.ravel()); k += len(c)
    gmsh.option.setNumber("Mesh.SaveAll", 1); gmsh.write(path)


def ring(fam, p, n=12, m=10, h0=1e-4, fault=None, curved=True):
    """A ring 1 < r < 2 of n x m cells in geometric layers, r and angle taken from the lattice (curved) or from straight cells."""
    q = np.cumsum(np.r_[0, h0 * (1 / h0) ** (np.arange(m) / (m - 1))]); q = 1 + q / q[-1]; ids, X = {}, []

    def node(a, r):
        k = (round(a % n, 9), round(r, 9))
        if k not in ids: i = int(min(r, m - 1e-9)); w = r - i; s = (1 - w) * q[i] + w * q[i + 1]; th = 2 * np.pi * k[0] / n; ids[k] = len(X) + 1; X.append((s * np.cos(th), s * np.sin(th)))
        return ids[k]
    ref = TYPES[GMSH[fam, p]][2]; cells = []
    for j in range(m):
        for i in range(n):  # (radius, angle): counterclockwise
            for c in ([((0, 0), (1, 0), (0, 1))] if fam == "quad" else [((0, 0), (1, 0), (1, 1)), ((0, 0), (1, 1), (0, 1))]):
                o, u, v = (np.array(z, float) for z in c)
                cells.append([node(i + (o + s * (u - o) + t * (v - o))[1], j + (o + s * (u - o) + t * (v - o))[0]) for s, t in ref])
    lr = TYPES[GMSH["line", p]][2][:, 0]; lines = {1: np.array([[node(i + s, m) for s in lr] for i in range(n)]), 2: np.array([[node(i + s, 0) for s in lr] for i in range(n)])}; X = np.array(X); cells = np.array(cells)
    if fault == "fold": k = cells[3][-1] - 1; X[k] += 2.5 * (q[1] - q[0]) * X[k] / np.linalg.norm(X[k])
    return X, {fam: cells}, lines


def self_test():
    tmp = tempfile.mkdtemp(); f = lambda n: os.path.join(tmp, n); ok = True
    gmsh.clear(); d = gmsh.model.occ.addDisk(0, 0, 0, 2, 2); e = gmsh.model.occ.addDisk(0, 0, 0, 1, 1); gmsh.model.occ.cut([(2, d)], [(2, e)]); gmsh.model.occ.synchronize(); gmsh.write(f("ring.step"))
    for fam in ("tri", "quad"):
        for p in (2, 3, 4):
            write_mesh(f("lin.msh"), *ring(fam, 1), 1); write_mesh(f("cur.msh"), *ring(fam, p), p); r = judge(f("lin.msh"), f("cur.msh"), f("ring.step"))
            good = r["certified"] == "yes" and r["invalid_elements"] == 0 and r["conforming"] and r["topology_kept"] and r["boundary_dist_max"] <= 1.01 * r["boundary_dist_baseline"] and r["wall_node_dist_max"] < 1e-12 and r["boundary_folded"] == 0
            write_mesh(f("bad.msh"), *ring(fam, p, fault="fold"), p); b = judge(f("lin.msh"), f("bad.msh"), f("ring.step"), peer=False); found = b["certified"] == "no" and b["invalid_elements"] > 0
            X, c, l = ring(fam, p); l[2] = l[2].copy(); X = np.vstack([X, X[l[2][0, 2] - 1] * 1.001]); l[2][0, 2] = len(X); write_mesh(f("off.msh"), X, c, l, p); o = judge(f("lin.msh"), f("off.msh"), f("ring.step"), peer=False)
            away = not o["conforming"] and o["wall_node_dist_max"] > 1e-5; ok &= good and found and away
            print("%s P%d: ring %s (certified %s, min C_JAC %.3f, C_WCN %.3f, distance %.2e, Gmsh %.2e, CAD from mesh %.2e; Gmsh alone: %d invalid); fold found: %s (%d); stray boundary node found: %s" % (
                fam, p, "ok" if good else "WRONG", r["certified"], r["cjac_min"], r["cwcn_min"], r["boundary_dist_max"], r.get("boundary_dist_baseline", -1), r["cad_dist_max"], r["peer"]["invalid_elements"], found, b["invalid_elements"], away))
    print("self-test", "passed" if ok else "FAILED"); return ok


def main():
    ap = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ap.add_argument("linear", nargs="?"); ap.add_argument("curved", nargs="?"); ap.add_argument("--cad"); ap.add_argument("--density", type=int, default=4); ap.add_argument("--json"); ap.add_argument("--no-certify", action="store_true")
    ap.add_argument("--no-peer", action="store_true"); ap.add_argument("--peer-only", type=int, metavar="P"); ap.add_argument("-o", "--out"); ap.add_argument("--self-test", action="store_true"); ap.add_argument("--quiet", action="store_true")
    a = ap.parse_args(); gmsh.initialize(["judge_2d"], False, False); gmsh.option.setNumber("General.Terminal", 0)
    if a.self_test: ok = self_test(); gmsh.finalize(); raise SystemExit(0 if ok else 1)
    if not a.linear: ap.error("LINEAR and CURVED")
    if a.peer_only:
        if not a.cad: ap.error("--peer-only needs --cad")
        out = a.out or os.path.join(tempfile.mkdtemp(), "plain.msh"); plain(a.linear, a.cad, a.peer_only, out); a.curved = out
    elif not a.curved: ap.error("CURVED")
    r = judge(a.linear, a.curved, a.cad, a.density, not a.no_certify, not a.no_peer); gmsh.finalize(); s = json.dumps(r, indent=1)
    if not a.quiet: print(s)
    if a.json: open(a.json, "w").write(s)


if __name__ == "__main__":
    main()
