"""Meshes of a robot in the pictures: found in packages and beside the URDF; what is missing is said."""

import logging
from dataclasses import replace
from pathlib import Path

import pytest
from trimesh import creation

import synthetic_run
from codesign.report.link_meshes import absence_in_words, absent_meshes
from codesign.report.reading import read_report_data
from codesign.report.scene import _link_pieces
from codesign.report.words import caveats
from codesign.report.writing import with_absent_meshes
from codesign.robot.description import RobotDescription

URDF = """<robot name="walker"><link name="trunk"><visual><origin xyz="0 0 1"/><geometry>
<mesh filename="package://walker_description/meshes/trunk.stl" scale="2 2 2"/></geometry></visual>
<visual><geometry><mesh filename="foot.stl"/></geometry></visual></link></robot>"""


@pytest.fixture
def walker(tmp_path: Path) -> RobotDescription:
    (tmp_path / "walker.urdf").write_text(URDF)
    return RobotDescription.load(tmp_path / "walker.urdf", as_published=True)


def install(tmp_path: Path) -> Path:
    """The package of the robot, with its one mesh, in a folder of packages."""
    folder = tmp_path / "share" / "walker_description" / "meshes"
    folder.mkdir(parents=True)
    creation.box(extents=[1.0, 1.0, 1.0]).export(folder / "trunk.stl")
    return tmp_path / "share"


def test_meshes_of_the_robot_itself_are_drawn_where_they_are_found(walker, tmp_path):
    creation.icosphere(radius=0.1).export(tmp_path / "foot.stl")
    trunk, foot = _link_pieces(walker, "trunk", {}, (install(tmp_path),))
    assert (trunk.points.min(axis=0).tolist(), trunk.points.max(axis=0).tolist()) == ([-1, -1, 0], [1, 1, 2])
    assert foot.points.max() == pytest.approx(0.1, rel=1e-3)
    assert absent_meshes(walker, (tmp_path / "share",)) == []


def test_missing_meshes_are_told_with_package_and_variable(walker, tmp_path):
    absent = absent_meshes(walker, ())
    assert absent == ["package://walker_description/meshes/trunk.stl", "foot.stl"]
    said = absence_in_words(absent)
    assert "2 meshes of the robot are not drawn" in said
    assert "Install the package walker_description" in said
    assert "ROS_PACKAGE_PATH" in said
    assert "foot.stl" in said
    assert absence_in_words([]) == ""


def test_the_report_and_the_log_name_what_is_missing(walker, tmp_path, caplog):
    study = type("Walking", (synthetic_run.Study,), {"base_robot": walker})()
    synthetic_run.write_run(tmp_path / "run", synthetic_run.evaluations(20))
    run = replace(read_report_data(tmp_path / "run", synthetic_run.Study()), notes=())
    with caplog.at_level(logging.WARNING):
        noted = with_absent_meshes(run, study, packages=())
    assert any("walker_description" in note for note in caveats(noted))
    assert "walker_description" in caplog.text
    assert with_absent_meshes(run, synthetic_run.Study(), packages=()) is run
