"""Linkage files from Python."""

import subprocess

import pytest
import sagitta


def test_a_linkage_is_written_validated_and_used(weeble, weeble_p2, program, tmp_path):
    mesh, cad = weeble
    file = tmp_path / "weeble.meshlink.xml"
    linked = sagitta.link(mesh, cad, file)
    subprocess.run([str(program), "link", mesh, "--cad", cad, "-o", tmp_path / "program.xml"], check=True, capture_output=True)
    assert file.read_bytes() == linked.linkage == (tmp_path / "program.xml").read_bytes()
    assert "face" in str(linked)

    found = sagitta.validate(file, mesh=mesh, cad=cad)
    assert found.is_clean(), str(found)
    curved = sagitta.curve(mesh, cad=cad, linkage=file, order=2)
    assert curved.report.certified and (curved.points == weeble_p2.points).all()


def test_a_mesh_in_memory_is_linked_by_its_name(weeble):
    linear = sagitta.read(weeble[0])
    linked = sagitta.link(linear, sagitta.Cad(weeble[1]), name="mine.msh")
    assert b"mine.msh" in linked.linkage


def test_findings_have_code_and_line(weeble, tmp_path):
    mesh, cad = weeble
    broken = tmp_path / "broken.xml"
    broken.write_text("<MeshLink>\n<nothing/>\n")
    found = sagitta.validate(broken)
    assert not found.is_clean() and found.findings[0]["severity"] == "error" and found.findings[0]["line"]
    with pytest.raises(sagitta.LinkageError) as caught:
        sagitta.curve(mesh, cad=cad, linkage=broken, order=2)
    assert caught.value.file == broken
