"""Curving from Python: the program's bytes, threads, interrupts, exceptions."""

import json
import os
import signal
import subprocess
import threading
import time

import numpy as np
import pytest
import sagitta
from conftest import FIXTURES


def run(program, *arguments):
    subprocess.run([str(program), *map(str, arguments)], check=True, capture_output=True)


def test_the_program_and_the_module_write_the_same_bytes(weeble, weeble_p2, program, tmp_path):
    mesh, cad = weeble
    report = tmp_path / "report.json"
    run(program, "curve", mesh, "--cad", cad, "--order", 2, "-o", tmp_path / "program.msh", "--report", report, "--quiet")
    weeble_p2.write(tmp_path / "module.msh")
    assert (tmp_path / "module.msh").read_bytes() == (tmp_path / "program.msh").read_bytes()

    ours, theirs = weeble_p2.report.data, json.loads(report.read_text())
    for varying in ("seconds", "peak_memory", "run"):
        ours.pop(varying), theirs.pop(varying)
    assert ours == theirs


def test_the_program_and_the_module_write_the_same_for_a_solver(weeble_p2, program, tmp_path):
    weeble_p2.write(tmp_path / "p2.msh")
    run(program, "convert", tmp_path / "p2.msh", "-o", tmp_path / "program.mesh", "--for", "mfem")
    notes = weeble_p2.write(tmp_path / "module.mesh", target="mfem")
    assert (tmp_path / "module.mesh").read_bytes() == (tmp_path / "program.mesh").read_bytes()
    assert all(isinstance(note, str) for note in notes)
    with pytest.raises(ValueError, match="mfem, "):
        weeble_p2.write(tmp_path / "a.msh", target="abaqus")
    with pytest.raises(sagitta.MeshError, match="tet"):
        weeble_p2.write(tmp_path / "a.h5", target="flexi")


def test_a_curved_mesh_tells_what_is_proven(weeble_p2):
    report = weeble_p2.report
    assert report.certified and not report.stopped and not report.off_cad and not report.open_faces
    bounds = weeble_p2.min_jacobians
    assert len(bounds) == len(weeble_p2.cells["tet"]) and bounds.min() >= report.min_jacobian > 0.5
    worst = report.worst(5)
    assert [own.min_jacobian for own in worst] == sorted(bounds)[:5] and worst[0].kind == "tet"
    assert bounds[worst[0].row] == worst[0].min_jacobian
    corners = weeble_p2.points[weeble_p2.cells["tet"][worst[0].row, :4]]
    assert np.allclose(corners.mean(axis=0), worst[0].position)
    assert weeble_p2.numbers("tet")[worst[0].row] == worst[0].number
    assert "certified: every element valid" in str(report)


def test_patches_know_their_cad(weeble, weeble_p2):
    linear, cad = sagitta.read(weeble[0]), sagitta.Cad(weeble[1])
    assert list(weeble_p2.patches) == list(linear.patches)
    faces = {entity.id for entity in cad.faces}
    for name, patch in weeble_p2.patches.items():
        nodes = patch.faces["triangle"]
        assert nodes.shape == (len(linear.patches[name].faces["triangle"]), 6)
        assert len(patch.cad_face) == len(patch.distance) == len(nodes)
        assert set(patch.cad_face) <= faces
        told = [own["cad_distance_max"] for own in weeble_p2.report.data["patches"] if own["names"] == [name]]
        assert patch.distance.max() == max(told) < 2e-3
        feet = cad.project(weeble_p2.points[nodes[:, 3]], group=sorted(set(patch.cad_face)))
        assert feet.distance.max() < 1e-9  # the nodes are on the CAD, the faces between them nearly


def test_a_mesh_of_arrays_is_curved(weeble, weeble_p2):
    linear = sagitta.read(weeble[0])
    patches = {name: dict(patch.faces) for name, patch in linear.patches.items()}
    curved = sagitta.curve(points=linear.points, cells=dict(linear.cells), patches=patches, cad=sagitta.Cad(weeble[1]), order=2)
    assert curved.report.certified and not curved.report.open_faces
    assert set(curved.patches["wall"].cad_face) == set(weeble_p2.patches["wall"].cad_face)
    ours, theirs = (own.points[: len(linear.points)] for own in (curved, weeble_p2))
    assert np.abs(ours - theirs).max() < 1e-2  # by geometry rather than by tags: nearly the same


def test_a_mesh_made_on_the_fly_is_curved():
    """Two layers of quadrilaterals between the circles of a CAD face."""
    n = 24
    angle, radius = 2 * np.pi * np.arange(n) / n, np.linspace(1.0, 2.0, 3)
    points = np.concatenate([np.column_stack([r * np.cos(angle), r * np.sin(angle)]) for r in radius])
    here, after = np.arange(n), (np.arange(n) + 1) % n
    quads = np.concatenate([np.column_stack([after, here, n + here, n + after]) + layer for layer in (0, n)])
    circle = np.column_stack([here, after])
    patches = {"inner": {"line": circle}, "outer": {"line": circle + 2 * n}}
    curved = sagitta.curve(points=points, cells={"quad": quads}, patches=patches, cad=FIXTURES / "annulus" / "annulus.step", order=4)
    assert curved.report.certified and curved.cells["quad"].shape == (2 * n, 25)
    for name, r in (("inner", 1.0), ("outer", 2.0)):
        nodes = curved.points[np.unique(curved.patches[name].faces["line"])]
        assert len(nodes) == 4 * n and np.allclose(np.hypot(*nodes[:, :2].T), r, atol=1e-9)


def test_two_curvings_at_once_are_those_of_one_alone(weeble, weeble_p2):
    found, ticks, done = {}, [], threading.Event()

    def work(threads):
        found[threads] = sagitta.curve(weeble[0], cad=weeble[1], order=2, threads=threads)

    def tick():  # Python goes on meanwhile
        while not done.is_set():
            ticks.append(time.monotonic())
            time.sleep(0.01)

    workers = [threading.Thread(target=work, args=(threads,)) for threads in (1, 2)]
    ticker = threading.Thread(target=tick)
    for thread in (ticker, *workers):
        thread.start()
    for thread in workers:
        thread.join()
    done.set()
    ticker.join()
    assert all((found[threads].points == weeble_p2.points).all() for threads in (1, 2))
    assert len(ticks) > 10 and np.diff(ticks).max() < 1.0


def test_progress_is_told_and_can_end_the_smoothing(weeble):
    seen = []

    def follow(at):
        seen.append(at)
        return at.step != "smooth"

    curved = sagitta.curve(weeble[0], cad=weeble[1], order=3, progress=follow)
    steps = [at.step for at in seen]
    assert steps[0] == "read" and {"associate", "project", "smooth", "certify"} <= set(steps)
    assert [at.order for at in seen if at.order is not None] == sorted(at.order for at in seen if at.order is not None)
    assert curved.report.stopped

    def fail(at):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        sagitta.curve(weeble[0], cad=weeble[1], order=2, progress=fail)


def test_an_interrupt_ends_the_work(weeble):
    timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        sagitta.curve(weeble[0], cad=weeble[1], order=4)
    assert time.monotonic() - start < 4.0
    timer.join()


def test_what_is_not_certified_is_an_exception(weeble, weeble_p2, monkeypatch):
    """No mesh of the fixtures ends without a certificate, so that a certified one stands in for it."""

    class Doubtful:
        certified = False

        def __getattr__(self, name):
            return getattr(weeble_p2._native, name)

    monkeypatch.setattr("sagitta._sagitta.curve", lambda *_: Doubtful())
    with pytest.raises(sagitta.NotCertified, match="weeble.msh: .*keep_invalid") as caught:
        sagitta.curve(weeble[0], cad=weeble[1], order=2)
    assert not caught.value.mesh.report.certified and len(caught.value.mesh.report.worst(3)) == 3
    assert not sagitta.curve(weeble[0], cad=weeble[1], order=2, keep_invalid=True).report.certified


def test_errors_name_file_and_place(weeble, tmp_path):
    mesh, cad = weeble
    absent, cut, text = tmp_path / "absent.msh", tmp_path / "cut.msh", tmp_path / "text.step"
    cut.write_bytes(mesh.read_bytes()[:20000])
    text.write_text("no CAD")
    with pytest.raises(sagitta.FileError) as caught:
        sagitta.curve(absent, cad=cad, order=2)
    assert isinstance(caught.value, OSError) and (caught.value.errno, caught.value.file) == (2, absent)
    with pytest.raises(sagitta.MeshError, match="cut") as caught:
        sagitta.read(cut)
    assert caught.value.file == cut and caught.value.place
    with pytest.raises(sagitta.CadError, match="not a CAD file") as caught:
        sagitta.curve(mesh, cad=text, order=2)
    assert caught.value.file == text
    with pytest.raises(sagitta.AssociationError, match="cad-scale 1000"):
        sagitta.curve(mesh, cad=cad, order=2, cad_scale=0.001)
    with pytest.raises(sagitta.MeshError, match="no boundary patch is called 'wings'|\"wings\""):
        sagitta.curve(mesh, cad=cad, order=2, only=["wings"])
    for wrong in ({"order": 5}, {"order": 2, "alpha": 2.0}, {"order": 2, "threads": 0}, {"order": 2, "tolerance": -1.0}):
        with pytest.raises(ValueError):
            sagitta.curve(mesh, cad=cad, **wrong)
    with pytest.raises(TypeError):
        sagitta.curve(cad=cad, order=2)


def test_cad_that_crashes_its_reader_is_an_exception(tmp_path):
    damaged = tmp_path / "dangling.step"
    damaged.write_text("ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n#1=MANIFOLD_SOLID_BREP('',#2);\nENDSEC;\nEND-ISO-10303-21;\n")
    with pytest.raises(sagitta.CadError) as caught:
        sagitta.Cad(damaged)
    assert caught.value.file == damaged
