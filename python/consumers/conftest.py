"""The fixtures of the tests."""

from pathlib import Path

import pytest
import sagitta

FIXTURES = Path(__file__).parents[2] / "fixtures"


@pytest.fixture(scope="session")
def weeble_p2():
    return sagitta.curve(FIXTURES / "weeble" / "weeble.msh", cad=FIXTURES / "weeble" / "weeble.step", order=2)
