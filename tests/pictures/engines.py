#!/usr/bin/env python3
"""The engines side by side: smallest costs over time, as a plot and as a table.

usage: engines.py SAGITTA OUT.png [--seconds S] [--threshold T]

Every engine curves the weeble and the wing (fixtures/) at P2 and P3, for S seconds at most (default 30), with the threshold
that the paper calls common (0.95) rather than the default, at which the weeble is soon done. What is drawn is the best state
so far, as the program keeps it: fewest inverted elements, then the largest harmonic mean of min C_WCN and min C_JAC. Seconds of order by order hold those at P2.
"""
import argparse
import csv
import pathlib
import subprocess
import tempfile

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

FIXTURES = pathlib.Path(__file__).resolve().parents[2] / "fixtures"
CASES = [(name, order) for name in ("weeble", "wing_sharp") for order in (2, 3)]
ENGINES = {
    "quasi-newton": ("#c0392b", ["--engine", "quasi-newton", "--direct"]),
    "quasi-newton, order by order": ("#d98e04", ["--engine", "quasi-newton"]),
    "gradient": ("#2c5f8a", ["--engine", "gradient"]),
}


def run(sagitta, name, order, engine, args, folder):
    """The rows of one run at the order asked for: seconds, sweep, min C_WCN, min C_JAC, inverted."""
    trace = folder / "trace.csv"
    base = FIXTURES / name / name
    command = [sagitta, "curve", f"{base}.msh", "--cad", f"{base}.step", "--order", order, *ENGINES[engine][1],
               "--trace", trace, "--threshold", args.threshold, "--max-sweeps", 1_000_000, "--time-limit", args.seconds, "--keep-invalid",
               "--quiet", "-o", folder / "out.msh"]
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode not in (0, 3, 4, 5):
        raise SystemExit(f"{name} P{order} {engine}: exit {done.returncode}\n{done.stderr}")
    with open(trace) as lines:
        rows = [row for row in csv.DictReader(lines) if int(row["order"]) == order]
    return [[float(row[key]) for key in ("seconds", "sweep", "c_wcn_min", "c_jac_min", "inverted")] for row in rows]


def best_so_far(rows, begin):
    """Times and costs at which the best state changed, the first at `begin`. A row's costs are those of the survey before its sweep."""
    seconds, wcn, jac, best = [], [], [], None
    for second, _, c_wcn, c_jac, inverted in rows:
        worst = min(c_wcn, c_jac)
        rank = (-inverted, 2 / (1 / c_wcn + 1 / c_jac) if worst > 0 else worst)
        if best is None or rank > best:
            best = rank
            seconds.append(second if seconds else begin)
            wcn.append(c_wcn)
            jac.append(c_jac)
    return [*seconds, rows[-1][0]], [*wcn, wcn[-1]], [*jac, jac[-1]]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sagitta")
    parser.add_argument("target")
    parser.add_argument("--seconds", type=float, default=30)
    parser.add_argument("--threshold", type=float, default=0.95)
    args = parser.parse_args()
    figure, axes = plt.subplots(2, 2, figsize=(11, 7), layout="constrained")
    print("| case | engine | sweeps | seconds | min C_WCN | min C_JAC | inverted |\n|---|---|---|---|---|---|---|")
    for axis, (name, order) in zip(axes.flat, CASES):
        for engine, (colour, _) in ENGINES.items():
            if "order by order" in engine and order == 2:
                continue  # there is no order below
            with tempfile.TemporaryDirectory() as folder:
                rows = run(args.sagitta, name, order, engine, args, pathlib.Path(folder))
            seconds, wcn, jac = best_so_far(rows, rows[0][0] if "order by order" in engine else 0.0)
            axis.step(seconds, jac, where="post", color=colour, label=f"{engine}: min C_JAC")
            axis.step(seconds, wcn, where="post", color=colour, linestyle=":", label=f"{engine}: min C_WCN")
            end, sweeps, c_wcn, c_jac, inverted = rows[-1]
            print(f"| {name} P{order} | {engine} | {sweeps:.0f} | {end:.1f} | {c_wcn:.3f} | {c_jac:.3f} | {inverted:.0f} |", flush=True)
        axis.set(title=f"{name} P{order}", xlabel="seconds of smoothing, lower orders included", xscale="symlog", xlim=(0, args.seconds))
        axis.grid(alpha=0.3)
    axes.flat[1].legend(fontsize="small")
    figure.savefig(args.target, dpi=110)


if __name__ == "__main__":
    main()
