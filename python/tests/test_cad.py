"""CAD from Python."""

import numpy as np
import pytest
import sagitta


@pytest.fixture(scope="module")
def cad(weeble):
    return sagitta.Cad(weeble[1])


def test_a_file_is_described(cad):
    assert [face.id for face in cad.faces] == [f"face:{n}" for n in range(1, 1 + len(cad.faces))]
    assert all(face.kind and face.reference.startswith("step:") for face in cad.faces)
    assert cad.scale == 1.0 and cad.unit and "4 faces" in repr(cad)
    lower, upper = np.array(cad.bounds)
    assert (lower < upper).all()


def test_feet_are_closest_points(cad):
    lower, upper = np.array(cad.bounds)
    points = lower + (upper - lower) * np.random.default_rng(1).random((200, 3))
    feet = cad.project(points)
    assert np.allclose(np.linalg.norm(points - feet.points, axis=1), feet.distance)
    assert feet.proven.dtype == bool and feet.proven.mean() > 0.9 and feet.parameters.shape == (200, 2)
    one = cad.project(points, group=["face:2"])
    assert set(one.entity) == {"face:2"} and (one.distance >= feet.distance - 1e-9).all()
    again = cad.project(feet.points)
    assert again.distance.max() < 1e-7


def test_references_to_nothing_are_told(cad):
    for wrong in ("face:99", "nonsense"):
        with pytest.raises(KeyError):
            cad.project(np.zeros((1, 3)), group=[wrong])


def test_a_scale_scales(cad, weeble):
    large = sagitta.Cad(weeble[1], scale=1000.0)
    assert np.allclose(np.array(large.bounds), 1000.0 * np.array(cad.bounds), rtol=1e-6)
