"""Kills, full disks and signals: what they leave behind, as a table in Markdown.

    python3 tests/reliability/harm.py SAGITTA [--kills 100] [--sizes 50]

Nothing but the standard library is needed; full disks need the right to mount a tmpfs (root, or `unshare -Urm`).
Ends with 1 where a promise of docs/reliability.md is not kept.
"""

import argparse
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"
SEED = 20261201
STEPS = 7


def case(name):
    return FIXTURES / name / f"{name}.msh", FIXTURES / name / f"{name}.step"


class Table:
    def __init__(self):
        self.broken = 0

    def row(self, what, tried, outcomes, broken):
        told = ", ".join(f"{count} {outcome}" for outcome, count in sorted(outcomes.items()))
        print(f"| {what} | {tried} | {told} | {len(broken)} |", flush=True)
        for line in broken[:5]:
            print(f"broken: {what}: {line}", file=sys.stderr)
        self.broken += len(broken)


def count(outcomes, outcome):
    outcomes[outcome] = outcomes.get(outcome, 0) + 1


def leftovers(folder, known):
    return sorted(set(os.listdir(folder)) - set(known))


def run(arguments, **more):
    return subprocess.run(arguments, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, **more).returncode


def kills(table, sagitta, tries):
    """SIGKILL at random times: the old file or the new one, whole; and nothing else after the next run."""
    mesh, cad = case("weeble")
    commands = {
        "curve": (["curve", mesh, "--cad", cad, "--order", "2", "-q"], "out.msh"),
        "convert to CGNS": (["convert", mesh], "out.cgns"),
        "convert to MSH": (["convert", mesh, "--ascii"], "out.msh"),
        "link": (["link", mesh, "--cad", cad], "out.xml"),
    }
    for what, (words, name) in commands.items():
        with tempfile.TemporaryDirectory() as folder:
            out = Path(folder, name)
            command = [sagitta, *words, "-o", out]
            start = time.monotonic()
            assert run(command) == 0
            length = time.monotonic() - start
            new, old = out.read_bytes(), b"old\n" * 1000
            outcomes, broken = {}, []
            for _ in range(tries):
                out.write_bytes(old)
                child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                time.sleep(random.uniform(0, 1.1 * length))
                child.kill()
                child.wait()
                now, left = out.read_bytes(), leftovers(folder, [name])
                count(outcomes, {old: "old", new: "new"}.get(now, "NEITHER") + (" with a part" if left else ""))
                if now not in (old, new):
                    broken.append(f"{len(now)} bytes")
                if left:
                    assert run(command) == 0
                    if leftovers(folder, [name]):
                        broken.append(f"left behind: {leftovers(folder, [name])}")
            table.row(f"SIGKILL, {what}", tries, outcomes, broken)


def full_disks(table, sagitta, sizes):
    """A disk with less and less room: whole and told as written, or the old file and exit code 2."""
    sample = FIXTURES / "samples/hexpyrtet_p3_msh41a.msh"
    forms = [["out.cgns"], ["out.msh"], ["out.msh", "--ascii"], ["out.msh", "--msh-version", "2.2"],
             ["out.msh", "--msh-version", "2.2", "--ascii"], ["out.vtu"], ["out.mesh"], ["out.meshb"]]
    with tempfile.TemporaryDirectory() as disk, tempfile.TemporaryDirectory() as elsewhere:
        if run(["mount", "-t", "tmpfs", "-o", "size=4m", "tmpfs", disk]) != 0:
            print("full disks: left out, as no tmpfs can be mounted here (unshare -Urm)", file=sys.stderr)
            return
        try:
            for name, *options in forms:
                reference = Path(elsewhere, name)
                assert run([sagitta, "convert", sample, "-o", reference, *options]) == 0
                new, old = reference.read_bytes(), b"old\n"
                outcomes, broken = {}, []
                for n in range(sizes):
                    out, filler = Path(disk, name), Path(disk, "filler")
                    filler.unlink(missing_ok=True)
                    out.write_bytes(old)
                    free = os.statvfs(disk).f_bavail * 4096
                    room = int(1.2 * len(new) * n / sizes) // 4096 * 4096
                    filler.write_bytes(bytes(free - room))
                    code = run([sagitta, "convert", sample, "-o", out, *options])
                    now = out.read_bytes()
                    count(outcomes, {0: "written", 2: "refused"}.get(code, f"exit {code}"))
                    if (code, now) not in ((0, new), (2, old)) or leftovers(disk, [name, "filler"]):
                        broken.append(f"room {room} of {len(new)}: exit {code}, {len(now)} bytes, {os.listdir(disk)}")
                table.row(f"full disk, {' '.join([name[4:], *options])}", sizes, outcomes, broken)
                Path(disk, name).unlink(missing_ok=True)
        finally:
            run(["umount", disk])


def hearing():
    """Under nohup the program would hear no SIGHUP, and nothing would be tried."""
    signal.signal(signal.SIGHUP, signal.SIG_DFL)


def signals(table, sagitta):
    """Each signal once and twice in each step of `curve`: no file or a valid one, and a documented exit code."""
    mesh, cad = case("weeble")
    for name in ("SIGINT", "SIGTERM", "SIGHUP", "SIGPIPE"):
        for times in (1, 2):
            outcomes, broken = {}, []
            for step in range(1, STEPS + 1):
                with tempfile.TemporaryDirectory() as folder:
                    out = Path(folder, "out.msh")
                    command = [sagitta, "curve", mesh, "--cad", cad, "--order", "2", "-o", out]
                    child = subprocess.Popen(
                        command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, preexec_fn=hearing)
                    for line in child.stderr:
                        if f" {step}/{STEPS} " in line:
                            break
                    child.send_signal(getattr(signal, name))
                    if times == 2:  # a second wish is one that comes a second later
                        time.sleep(0.02)
                        child.send_signal(signal.SIGSTOP)
                        time.sleep(1.1)
                        child.send_signal(getattr(signal, name))
                        child.send_signal(signal.SIGCONT)
                    child.stderr.read()
                    code = child.wait()
                    count(outcomes, f"exit {code}")
                    written = out.exists()
                    valid = not written or run([sagitta, "check", out, "--linear", mesh]) == 0
                    known = code in ((0, 3, 5, 6) if written else (130,))
                    if not valid or not known or leftovers(folder, ["out.msh"]):
                        broken.append(f"step {step}: exit {code}, {os.listdir(folder)}, valid {valid}")
            table.row(f"{name}, {'once' if times == 1 else 'twice'}, in each step of `curve`", STEPS, outcomes, broken)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sagitta", type=Path)
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--sizes", type=int, default=50)
    options = parser.parse_args()
    random.seed(SEED)
    sagitta, table = options.sagitta.resolve(), Table()
    print("| what | times | outcomes | broken |\n|---|---|---|---|")
    kills(table, sagitta, options.kills)
    full_disks(table, sagitta, options.sizes)
    signals(table, sagitta)
    return 1 if table.broken else 0


if __name__ == "__main__":
    sys.exit(main())
