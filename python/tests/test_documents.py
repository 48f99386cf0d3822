"""The examples of docs/python.md run, one after the other; those of a library only where it is installed."""

import re
import shutil
from pathlib import Path

import pytest
import sagitta

DOCUMENT = Path(__file__).parents[2] / "docs" / "python.md"
FIXTURES = DOCUMENT.parents[1] / "fixtures"

#: Libraries of solvers, which not every environment has.
OTHERS = ("mfem", "mpi4py", "dolfinx", "ngsolve")


def test_the_examples_run(tmp_path, monkeypatch, capsys):
    for name in ("weeble/weeble.msh", "weeble/weeble.step", "annulus/annulus.step"):
        shutil.copy(FIXTURES / name, tmp_path)
    monkeypatch.chdir(tmp_path)
    names, ran, left_out = {}, 0, []
    for block in re.findall(r"```python\n(.*?)```", DOCUMENT.read_text(), re.DOTALL):
        try:
            exec(compile(block, str(DOCUMENT), "exec"), names)
            ran += 1
        except ImportError as error:
            left_out.append(error.name)
    assert ran >= 6 and all(name.split(".")[0] in (*OTHERS, "pyvista", "meshio") for name in left_out), left_out


def test_every_public_name_is_documented():
    for name in sagitta.__all__:
        assert getattr(sagitta, name).__doc__, name
    with pytest.raises(AttributeError):
        sagitta.nothing
