#!/usr/bin/env python3
"""Collects the licences of all that a wheel holds: `python/licences.py FOLDER BINARY..`. Files of Debian packages that the binaries' shared
libraries come from, and a list of the Rust crates with theirs."""

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

# What auditwheel leaves to the system.
OF_THE_SYSTEM = re.compile(r"(libc|libm|libgcc_s|libstdc\+\+|libdl|librt|libpthread|ld-linux.*)\.so")
ROOT = Path(__file__).resolve().parents[1]


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True, cwd=ROOT).stdout


def libraries(binary):
    for line in run("ldd", binary).splitlines():
        found = re.search(r"=> (/\S+)", line)
        if found and not OF_THE_SYSTEM.match(Path(found[1]).name):
            yield Path(found[1]).resolve()


def package(library):
    """The Debian package of a library; merged /usr leaves some of them known without it."""
    for name in (str(library), str(library).removeprefix("/usr")):
        found = subprocess.run(["dpkg-query", "-S", name], capture_output=True, text=True)
        if found.returncode == 0:
            return found.stdout.split(":")[0]
    sys.exit(f"licences: {library}: of no Debian package, so that its licence is not known")


def main(folder, *binaries):
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    for name in ("LICENSE-MIT", "LICENSE-APACHE"):
        shutil.copy(ROOT / name, folder / name)
    for name in sorted({package(library) for binary in binaries for library in libraries(binary)}):
        shutil.copy(f"/usr/share/doc/{name}/copyright", folder / f"{name}.txt")
    shutil.copy("/usr/share/common-licenses/LGPL-2.1", folder / "LGPL-2.1")
    metadata = json.loads(run("cargo", "metadata", "--format-version", "1", "--locked", "--features", "static-hdf5", "--filter-platform", "x86_64-unknown-linux-gnu"))
    crates = sorted(f"{own['name']} {own['version']}: {own['license']} {own['repository'] or ''}" for own in metadata["packages"] if own["source"])
    (folder / "rust-crates.txt").write_text("\n".join(crates) + "\n")
    sources = {own["name"]: Path(own["manifest_path"]).parent for own in metadata["packages"]}
    shutil.copy(sources["hdf5-metno-src"] / "ext/hdf5/LICENSE", folder / "HDF5.txt")
    shutil.copy(sources["libz-sys"] / "src/zlib/LICENSE", folder / "zlib.txt")


main(*sys.argv[1:])
