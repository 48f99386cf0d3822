"""Do sagitta's readers and the strict parsers of `strict/` accept the same files, and find the same in them? A table in Markdown.

    python3 tests/reliability/agree.py ACCOUNT [--mutants 10000] [--only NAME] [--seed N] [--keep FOLDER]

ACCOUNT is fuzz/target/release/account, which `make parsers` builds. Nothing but the standard library is needed. Ends with 1 where a file is accepted by one
and refused by the other, or both read it and find other things.
"""

import argparse
import math
import random
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import strict

SAMPLES = Path(__file__).resolve().parents[2] / "fixtures" / "samples"
FORMATS = {
    "MSH 2.2": ["hexpyrtet_p1_msh22a.msh", "prism_p4_msh22a.msh", "circle2d_p2_msh22a.msh", "periodic_tet_p1_msh22a.msh"],
    "MSH 4.1": ["hexpyrtet_p1_msh41a.msh", "hexpyrtet_p3_msh41a.msh"],
    "SU2": ["hexpyrtet_p1.su2", "circle2d_p1.su2", "cylprism_p1.su2"],
    "GMF": ["hexpyrtet_p1.mesh"],
    "MFEM": ["mfem_hexes_p1.mfem"],
    "UGRID": ["hexpyrtet_p1.ugrid", "hexpyrtet_p1.b8.ugrid", "hexpyrtet_p1.lb4.ugrid", "hexpyrtet_p1.lr8.ugrid", "hexpyrtet_p1.lb8l.ugrid"],
    "legacy VTK": ["hexpyrtet_p1.vtk", "hexpyrtet_p1_legacy51_ascii.vtk", "circle2d_p1.vtk"],
    "VTU": ["hexpyrtet_p1_ascii.vtu", "hexpyrtet_p1_app_raw.vtu", "hexpyrtet_p1_app_b64.vtu", "hexpyrtet_p1_app_raw_zlib.vtu", "hex_p3.vtu"],
}
# What notes say where something of the file was left out, or changed.
TELLING = ("not used", "which is not known", "no name can have", "may have been cut off")
NUMBERS = [b"-1", b"0", b"1", b"2", b"7", b"99999999999999", b"nan", b"1e400", b"0.5", b"18446744073709551615", b"12a", b""]


def mutant(content):
    """One or two faults: in bytes, words or lines."""
    content = bytearray(content)
    for _ in range(random.choice((1, 1, 2))):
        at = random.randrange(max(len(content), 1))
        if random.random() < 0.3:
            at %= 600
        kind = random.randrange(10)
        word = next((n for n in range(at, -1, -1) if content[n : n + 1].isspace()), -1) + 1
        end = next((n for n in range(at, len(content)) if content[n : n + 1].isspace()), len(content))
        line = content.rfind(b"\n", 0, at) + 1
        line_end = content.find(b"\n", at) + 1 or len(content)
        if kind == 0:
            del content[at:]
        elif kind == 1:
            content[at : at + 1] = bytes([content[at] ^ 1 << random.randrange(8)]) if content[at : at + 1] else b""
        elif kind == 2:
            del content[at : at + random.randrange(1, 16)]
        elif kind == 3:
            content[at:at] = content[at : at + random.randrange(1, 16)]
        elif kind == 4:
            del content[line:line_end]
        elif kind == 5:
            content[line:line] = content[line:line_end]
        elif kind == 6:
            content[at : at + 4] = random.choice((0, 1, 3, 2**31 - 1, 2**32 - 1)).to_bytes(4, random.choice(("little", "big")))
        elif kind in (7, 8):
            # A word of another value: another number, or that of elsewhere.
            other = random.choice((bytes(content).split() or [b"1"])) if kind == 7 else random.choice(NUMBERS)
            content[word:end] = other[:40]
        else:
            # A word more or less on a line.
            content[word:end] = random.choice((b"", bytes(content[word:end]) + b" 1"))
    return bytes(content)


def near(a, b, size):
    if not (math.isfinite(a) and math.isfinite(b)):
        return True  # sums beyond what a double holds
    return abs(a - b) <= 1e-9 * max(size, abs(a), abs(b))


def differences(text, own):
    """What account's line says otherwise than the strict parser's figures."""
    words = text.split()
    order, points, sums, size, kinds, entities = own
    if int(words[1]) != order or int(words[3]) != points:
        return f"order and points {words[1]}, {words[3]} and {order}, {points}"
    if not all(near(float(word), value, size) for word, value in zip(words[4:7], sums)):
        return "the points' coordinates"
    end = words.index("entities")
    told = {words[n]: words[n + 1 : n + 4] for n in range(7, end, 4)}
    if {kind: int(row[0]) for kind, row in told.items()} != {kind: row[0] for kind, row in kinds.items()}:
        return "the elements' number"
    for kind, row in kinds.items():
        if not near(float(told[kind][1]), row[1], row[3]) or not near(float(told[kind][2]), row[2], row[2]):
            return f"the nodes of {kind} elements"
    if words[end + 1 :] != ([",".join(entities)] if entities else []):
        return f"entities {words[end + 1:]} and {entities}"
    return None


class Judge:
    def __init__(self, account, keep):
        self.process = subprocess.Popen([account], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, errors="replace")
        self.keep, self.counts, self.reasons = keep, Counter(), []

    def judge(self, path):
        print(path, file=self.process.stdin, flush=True)
        answer = self.process.stdout.readline().rstrip("\n")
        if not answer:
            raise SystemExit(f"{path}: account ended")
        told = answer.startswith("ok ")
        answer, _, notes = answer.partition("\t")
        try:
            own, why = strict.read(str(path)).figures(), ""
        except strict.Refused as refusal:
            own, why = None, str(refusal)
        if told and own:
            difference = differences(answer[3:], own)
            return ("both read", None) if difference is None else ("other figures", difference)
        if told and any(telling in notes for telling in TELLING):
            return "read, with a note", None
        if told:
            return "read by sagitta alone", why
        return ("both refuse", None) if own is None else ("refused by sagitta alone", answer)

    def format(self, name, mutants, folder):
        # Small samples are the quicker ones, and no worse.
        weights = [1 / (SAMPLES / sample).stat().st_size for sample in FORMATS[name]]
        for n in range(mutants):
            sample = random.choices(FORMATS[name], weights)[0]
            path = Path(folder, sample)
            path.write_bytes(mutant((SAMPLES / sample).read_bytes()))
            outcome, why = self.judge(path)
            self.counts[name, outcome] += 1
            if why is not None:
                self.reasons.append(f"{name}, mutant {n} of {sample}: {outcome}: {why}")
                if self.keep:
                    kept = Path(self.keep, f"{n}_{sample}")
                    kept.write_bytes(path.read_bytes())
            path.unlink()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("account")
    parser.add_argument("--mutants", type=int, default=10000)
    parser.add_argument("--only", choices=FORMATS)
    parser.add_argument("--seed", type=int, default=20261201)
    parser.add_argument("--keep", help="a folder for the files that are disagreed about")
    options = parser.parse_args()
    judge = Judge(options.account, options.keep)
    outcomes = ("both read", "both refuse", "read, with a note", "read by sagitta alone", "refused by sagitta alone", "other figures")
    print(f"| format | {' | '.join(outcomes)} |\n|---|{'---|' * len(outcomes)}", flush=True)
    for name in [options.only] if options.only else FORMATS:
        random.seed(f"{options.seed} {name}")
        with tempfile.TemporaryDirectory(dir="/dev/shm" if Path("/dev/shm").is_dir() else None) as folder:
            for sample in FORMATS[name]:
                path = Path(folder, sample)
                path.write_bytes((SAMPLES / sample).read_bytes())
                outcome, why = judge.judge(path)
                if outcome != "both read":
                    raise SystemExit(f"{sample}, whole: {outcome}: {why}")
            judge.format(name, options.mutants, folder)
        print(f"| {name} | {' | '.join(str(judge.counts[name, outcome]) for outcome in outcomes)} |", flush=True)
    for reason in judge.reasons:
        print(reason, file=sys.stderr)
    sys.exit(1 if judge.reasons else 0)


if __name__ == "__main__":
    main()
