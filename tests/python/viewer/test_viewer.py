"""The viewer: what it shows without a browser, and in a real one."""

import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import synthetic_run
from browser import open_browser, visit
from codesign.chain.study import load_study
from codesign.errors import CodesignError
from codesign.report.details import FOLDER, save_detail
from codesign.report.link_meshes import link_meshes, package_paths
from codesign.report.reading import read_report_data
from codesign.report.scene import robot_scene
from codesign.viewer import viewer as viewing
from codesign.viewer.actor import quaternions, tinted_mesh
from codesign.viewer.panel import joint_angles, legend
from synthetic_details import detail

STUDY = synthetic_run.Study()


@pytest.fixture(scope="module")
def run_directory(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder: Path = tmp_path_factory.mktemp("viewer") / "run"
    synthetic_run.write_run(folder, synthetic_run.evaluations(60))
    run = read_report_data(folder, STUDY, synthetic_run.evaluate(synthetic_run.BASELINE))
    for evaluation in run.highlights.values():
        save_detail(folder / FOLDER, detail(evaluation))
    return folder


@pytest.fixture(scope="module")
def viewer(run_directory: Path) -> Iterator[viewing.Viewer]:
    shown = viewing.view(STUDY, run_directory=run_directory, port=0, packages=())
    yield shown
    shown.stop()


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    yield from open_browser()


def test_sliders_predict_other_designs(viewer):
    assert viewer.what_if is not None
    assert "evaluated as design" in viewer.what_if.text
    viewer.what_if.set((8, 10, 4, 33))
    assert "Momentum error: **" in viewer.what_if.text
    assert "(90 %: " in viewer.what_if.text
    assert "leave-one-out" in viewer.what_if.text
    viewer.what_if.set((78, 10, 4, 33))
    assert "Outside of all designs with a result" in viewer.what_if.text
    assert "(90 %: " not in viewer.what_if.text


def test_the_run_offers_its_designs(viewer):
    names = viewer.names
    assert names[0] == "recommended"
    assert "original" in names
    assert any(re.fullmatch(r"design \d+", name) for name in names)


def test_going_to_a_moment_moves_the_robot(viewer):
    viewer.go_to(2.0)
    before = np.array(viewer.link_position("root_link"))
    viewer.go_to(12.0)
    assert viewer.time == pytest.approx(12.0, abs=0.03)
    assert np.allclose(np.array(viewer.link_position("root_link")) - before, [1.0, 0.0, 0.5], atol=0.02)


def test_another_design_is_shown_on_request(viewer):
    viewer.show("original")
    assert "Bracket angle: **15°**" in viewer.facts
    assert "Bracket distance: **42 mm**" in viewer.facts
    viewer.show("recommended")
    assert "Bracket angle: **15°**" not in viewer.facts


def test_the_world_passes_under_a_robot_that_the_camera_follows(viewer):
    viewer.show("recommended")
    viewer.go_to(12.0)
    assert np.linalg.norm(viewer.world_position) > 0.5
    viewer.follow(False)
    assert viewer.world_position == (0.0, 0.0, 0.0)
    viewer.follow(True)
    viewer.go_to(0.0)
    assert viewer.world_position == (0.0, 0.0, 0.0)


def test_stress_colors_are_lit_like_paint_not_like_metal():
    mesh = tinted_mesh(np.eye(3), np.array([[0, 1, 2]]), np.array([[1.0, 0.0, 0.0]] * 3))
    data = mesh.export(file_type="glb")
    document = json.loads(data[20 : 20 + int.from_bytes(data[12:16], "little")])
    assert document["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] == 0.0
    assert "COLOR_0" in document["meshes"][0]["primitives"][0]["attributes"]


def test_the_command_says_where_the_page_is_and_records_flights(tmp_path):
    command = [sys.executable, "-m", "codesign.cli", "view", "--study", "gimbal_quad", "--set", "reach=200"]
    command += ["--set", "height=30", "--port", "0"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert re.match(r"viewer: http://127\.0\.0\.1:\d+ ", process.stdout.readline())
        finally:
            process.terminate()
    subprocess.run([*command, "--record", str(tmp_path / "flight.html")], check=True, stdout=subprocess.DEVNULL)
    assert 1e5 < (tmp_path / "flight.html").stat().st_size < 15e6


def test_nothing_to_show_is_a_clear_error(tmp_path):
    bare = type("Bare", (synthetic_run.Study,), {"baseline": None})()
    synthetic_run.write_run(tmp_path / "run", [])
    with pytest.raises(CodesignError, match="nothing to show"):
        viewing.view(bare, run_directory=tmp_path / "run", port=0)


def test_the_panel_names_units_the_scale_of_the_colors_and_joint_angles():
    shown = detail(synthetic_run.evaluate(synthetic_run.BASELINE))
    assert "Jetpack bracket</span><span>5.3 MPa" in legend(shown).replace("5.30", "5.3")
    assert joint_angles(shown, 3.0).startswith("j0: **0.0°**")


def drawn(page: Any) -> np.ndarray:
    """Pixels of the 3-D scene alone: without the panel at its right and the time line at its bottom."""
    page.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
    picture = np.asarray(Image.open(BytesIO(page.locator("canvas").first.screenshot())).convert("RGB"), dtype=int)
    return picture[: int(0.7 * picture.shape[0]), : int(0.55 * picture.shape[1])]


def test_quaternions_turn_as_the_matrices_do():
    c, s = np.cos(0.3), np.sin(0.3)
    turned = quaternions(np.array([np.eye(3), [[c, -s, 0], [s, c, 0], [0, 0, 1]]]))
    assert np.allclose(turned, [[1, 0, 0, 0], [np.cos(0.15), 0, 0, np.sin(0.15)]])


def test_the_browser_shows_the_robot_and_plays_the_flight(browser, viewer):
    viewer.go_to(0.0)
    with visit(browser, viewer.address, local=(viewer.address,), width=700, height=420) as page:
        page.get_by_role("button", name="Play").wait_for()
        canvas = page.locator("canvas").first
        canvas.wait_for()
        page.wait_for_timeout(1500)
        before = drawn(page)
        assert len(np.unique(before.reshape(-1, 3), axis=0)) > 50  # a shaded robot, not an empty canvas
        page.get_by_role("button", name="Play").click()
        page.get_by_role("button", name="Pause").wait_for()
        page.wait_for_timeout(2500)
        page.get_by_role("button", name="Pause").click()
        page.get_by_role("button", name="Play").wait_for()  # the server has answered
        assert 0.5 < viewer.time < 30.0
        assert not viewer.playing
        page.wait_for_timeout(500)
        assert (np.abs(drawn(page) - before).max(axis=2) > 20).mean() > 0.002


def test_a_recording_plays_without_a_server(browser, run_directory, tmp_path):
    path = viewing.record(tmp_path / "flight.html", STUDY, run_directory=run_directory, packages=())
    assert path.stat().st_size < 15e6
    with visit(browser, path.as_uri(), width=480, height=320) as page:
        canvas = page.locator("canvas").first
        canvas.wait_for()
        page.wait_for_timeout(2000)
        early = drawn(page)
        assert len(np.unique(early.reshape(-1, 3), axis=0)) > 50
        page.wait_for_timeout(3000)
        assert (np.abs(drawn(page) - early).max(axis=2) > 20).mean() > 0.002


def test_package_paths_follow_the_usual_variables(tmp_path):
    (tmp_path / "ws" / "share").mkdir(parents=True)
    environment = {"ROS_PACKAGE_PATH": f"{tmp_path}{os.pathsep}/nowhere", "AMENT_PREFIX_PATH": str(tmp_path / "ws")}
    assert package_paths(environment) == (tmp_path, tmp_path / "ws" / "share")


def test_real_link_meshes_replace_the_plain_shapes_where_they_are_installed(shared_data, tmp_path):
    shutil.copytree(shared_data / "ironcub_mk3", tmp_path / "iRonCub-Mk3" / "iRonCub")
    study = load_study("ironcub_paper")
    plain = robot_scene(study, synthetic_run.BASELINE, packages=())
    real = robot_scene(study, synthetic_run.BASELINE, packages=(tmp_path,))
    assert {p.link for p in real.pieces} == {p.link for p in plain.pieces}
    assert sum(len(p.triangles) for p in real.pieces) > 5 * sum(len(p.triangles) for p in plain.pieces)
    assert {p.link for p in real.pieces if p.part} == {p.link for p in plain.pieces if p.part}
    for link in ("chest", "root_link", "l_upper_leg", "chest_jetpack"):  # shapes and meshes are in the same place
        boxes = [np.concatenate([p.points for p in s.pieces if p.link == link]) for s in (plain, real)]
        centers = [(box.min(axis=0) + box.max(axis=0)) / 2.0 for box in boxes]
        assert np.allclose(*centers, atol=0.1), link


def test_without_the_package_there_are_no_meshes(tmp_path):
    assert link_meshes("package://iRonCub-Mk3/iRonCub/robots/iRonCub-Mk3/model_stl.urdf", (tmp_path,)).meshes == {}
