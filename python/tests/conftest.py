"""Meshes of the fixtures, curved once for all tests."""

import os
from pathlib import Path

import pytest
import sagitta
import sagitta.program

FIXTURES = Path(__file__).parents[2] / "fixtures"


@pytest.fixture(scope="session")
def weeble():
    return FIXTURES / "weeble" / "weeble.msh", FIXTURES / "weeble" / "weeble.step"


@pytest.fixture(scope="session")
def weeble_p2(weeble):
    mesh, cad = weeble
    return sagitta.curve(mesh, cad=cad, order=2)


@pytest.fixture(scope="session")
def program():
    """The program beside the module: that of the build, or of the package that is tested."""
    return os.environ.get("SAGITTA") or sagitta.program.path()
