"""The program ``sagitta``, which is in the package: what the command of that name runs."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import NoReturn

__all__ = ["main", "path"]


def path() -> Path:
    """The program."""
    return Path(__file__).with_name("bin") / "sagitta"


def main() -> NoReturn:
    """Becomes the program, with the arguments of this process."""
    program = os.fspath(path())
    try:
        os.execv(program, [program, *sys.argv[1:]])
    except OSError as error:
        sys.exit(f"sagitta: {program}: cannot be run: {error}; install sagitta again")
