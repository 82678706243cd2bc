"""Figures of a run: the software renderer, the robot's solids, and that every figure shows what it says."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from trimesh import Trimesh, creation

import synthetic_run
from codesign.problem.evaluation import Evaluation
from codesign.report.data import Entry, ReportData
from codesign.report.details import detail_key
from codesign.report.figures import FIGURES, FigureData, solids, write_figures
from codesign.report.figures.flights import command
from codesign.report.figures.solids import close_up, posture, stress_tint
from codesign.report.figures.style import style
from codesign.report.raster import Body, View, fitting_view, render
from codesign.report.reading import read_report_data
from codesign.report.scene import robot_scene
from codesign.report.validation import Disturbance, Flight, Validation
from figure_text import outside, overlaps
from synthetic_details import detail

STUDY = synthetic_run.Study()
WHITE = np.array([1.0, 1.0, 1.0])


def cube(size: float, center: tuple[float, float, float], color: np.ndarray = WHITE, lit: bool = True) -> Body:
    mesh = creation.box(extents=[size] * 3)
    return Body(np.asarray(mesh.vertices) + center, np.asarray(mesh.faces), color, lit)


def test_a_cube_covers_the_pixels_it_should():
    picture = render([cube(1.0, (0, 0, 0))], View(0.0, 0.0, (0, 0, 0), 2.0), 100, 100)
    assert (picture[..., 3] > 0).sum() == 50 * 50
    assert picture[24, 50, 3] == 0
    assert picture[26, 50, 3] == 255


def test_the_nearer_body_hides_the_farther_one():
    red, green = np.array([1.0, 0, 0]), np.array([0, 1.0, 0])
    bodies = [cube(1.0, (-3, 0, 0), red, lit=False), cube(0.5, (3, 0, 0), green, lit=False)]
    front = render(bodies, View(0.0, 0.0, (0, 0, 0), 2.0), 80, 80)
    back = render(bodies, View(180.0, 0.0, (0, 0, 0), 2.0), 80, 80)
    assert front[40, 40, :3].tolist() == [0, 255, 0]
    assert back[40, 40, :3].tolist() == [255, 0, 0]


def test_up_is_up_and_right_is_right_seen_from_the_front():
    body = cube(0.5, (0, 1.0, 1.0))  # seen from +x: y to the right, z up
    picture = render([body], View(0.0, 0.0, (0, 0, 0), 4.0), 80, 80)
    rows, columns = np.nonzero(picture[..., 3])
    assert (rows.mean(), columns.mean()) == pytest.approx((19.5, 59.5), abs=0.6)


def test_colors_are_interpolated_over_a_face():
    mesh = creation.box(extents=[1, 1, 1])
    colors = np.repeat((np.asarray(mesh.vertices)[:, 1:2] + 0.5), 3, axis=1)
    body = Body(np.asarray(mesh.vertices), np.asarray(mesh.faces), colors, lit=False)
    picture = render([body], View(0.0, 0.0, (0, 0, 0), 1.2), 120, 120)
    assert float(picture[60, 60, 0]) == pytest.approx(127, abs=3)
    assert float(picture[60, 85, 0]) == pytest.approx(255 * 0.755, abs=3)


def test_the_fitting_view_holds_everything():
    body = cube(1.0, (5, -2, 3))
    picture = render([body], fitting_view([body], 35.0, 25.0, aspect=1.5), 150, 100)
    border = np.concatenate([picture[0], picture[-1], picture[:, 0], picture[:, -1]])
    assert picture[..., 3].any()
    assert not border[:, 3].any()


def test_the_scene_holds_parts_of_the_design_on_both_sides():
    scene = robot_scene(STUDY, synthetic_run.BASELINE)
    placed = {piece.link: piece for piece in scene.pieces if piece.part}
    assert {link: piece.part for link, piece in placed.items()} == {
        "chest_l_bracket": "jetpack_bracket",
        "chest_r_bracket": "jetpack_bracket",
        "l_forearm": "forearm_support",
        "r_forearm": "forearm_support",
    }
    for piece in scene.pieces:
        assert Trimesh(piece.points, piece.triangles).volume > 0, piece.link
    left, right = placed["l_forearm"].points, placed["r_forearm"].points
    assert np.allclose(left.min(axis=0)[2], -right.max(axis=0)[2])


def test_the_parts_touch_what_they_carry():
    scene = robot_scene(STUDY, synthetic_run.BASELINE)
    poses = scene.poses(np.zeros(len(scene.joints)))
    for jet in scene.jets:
        gaps = []
        for piece in scene.pieces:
            if piece.part:
                points = piece.points @ poses[piece.link][:3, :3].T + poses[piece.link][:3, 3]
                gaps.append(np.linalg.norm(points - poses[jet][:3, 3], axis=1).min())
        assert min(gaps) < 0.2, jet  # the jet frame lies in its engine, which the part holds


def test_postures_move_with_the_flight():
    scene = robot_scene(STUDY, synthetic_run.BASELINE)
    joints = np.zeros((3, len(scene.joints)))
    joints[:, scene.joints.index("l_elbow")] = [0.0, 0.5, 1.0]
    hand = scene.poses(joints)["l_arm_jet_turbine"]
    assert hand.shape == (3, 4, 4)
    assert np.linalg.norm(hand[2, :3, 3] - hand[0, :3, 3]) > 0.1


def test_stress_colors_darken_with_stress():
    tint = stress_tint(np.linspace(0.0, 1e6, 50), 1e6)
    lightness = tint @ [0.2126, 0.7152, 0.0722]
    assert (np.diff(lightness) < 0).all()


def test_commands_are_named_as_a_pilot_would():
    windows = STUDY.config.trajectories["envelope"].windows
    assert [command(window) for window in windows] == ["up", "forward", "pitch", "down", "yaw left"]


@pytest.fixture(scope="module")
def data(tmp_path_factory: pytest.TempPathFactory) -> FigureData:
    folder: Path = tmp_path_factory.mktemp("figures") / "run"
    synthetic_run.write_run(folder, synthetic_run.evaluations(120))
    run = read_report_data(folder, STUDY, synthetic_run.evaluate(synthetic_run.BASELINE))
    return FigureData(run, {detail_key(e): detail(e) for e in run.highlights.values()}, STUDY, validated(run))


def validated(run: ReportData) -> Validation:
    """Made-up flights of the highlighted designs: calm ones and disturbed ones."""
    random = np.random.default_rng(2)
    found = []
    for role, evaluation in sorted(run.highlights.items(), key=lambda item: item[0] != "original"):
        for trajectory, seed in [("climb", None), ("turn", None), *(("turn", seed) for seed in range(8))]:
            values = {key: value * (1 + 0.02 * random.normal()) for key, value in evaluation.objectives.items()}
            found.append(Flight(role, dict(evaluation.design), trajectory, seed, True, None, values, {}))
    return Validation(tuple(found), Disturbance())


def with_long_words(data: FigureData) -> FigureData:
    """The same with names as long as people write them."""
    longer = {"momentum": "Largest deviation of the spatial momentum", "thrust": "Mean total thrust of all engines"}
    objectives = tuple(replace(o, label=longer.get(o.key, o.label)) for o in data.run.objectives)
    labels = {v.name: f"{data.run.label(v)} measured from the mounting flange" for v in data.run.variables}
    run = replace(data.run, objectives=objectives, labels=labels)
    groups = tuple(f"{name} joints that the pilot moves" for name in ("torso", "left arm", "right arm"))
    details = {k: replace(d, flight=replace(d.flight, groups=groups)) for k, d in data.details.items()}
    return FigureData(run, details, data.study, validated(run))


@pytest.mark.parametrize("kind", FIGURES, ids=lambda kind: kind.name)
@pytest.mark.parametrize("words", ["short", "long"])
def test_every_figure_is_drawn_and_no_text_overlaps(data, kind, words, monkeypatch):
    shown = data
    if words == "long":
        shown = with_long_words(data)
        monkeypatch.setattr(solids, "render", lambda *_: np.full((10, 15, 4), 255, dtype=np.uint8))  # only words count
    with style():
        figure = kind.draw(shown)
        assert figure is not None
        assert overlaps(figure) == []
        assert outside(figure) == []
    assert all(axes.has_data() or axes.images for axes in figure.axes)


def test_six_objectives_fit_their_figures(data):
    extra = [
        replace(data.run.objectives[0], key=f"extra_{k}", label=f"Objective number {k} of the study") for k in range(3)
    ]
    entries = tuple(
        Entry(e.id, replace(e.evaluation, objectives=e.evaluation.objectives | _more(e.evaluation)), e.generation)
        for e in data.run.entries
    )
    baseline = replace(data.run.baseline, objectives=data.run.baseline.objectives | _more(data.run.baseline))
    run = replace(data.run, objectives=(*data.run.objectives, *extra), entries=entries, baseline=baseline)
    wide = FigureData(run, {}, data.study, validated(run))
    with style():
        for kind in FIGURES:
            if kind.name in ("projections", "parallel", "chosen", "validation"):
                assert overlaps(kind.draw(wide)) == [], kind.name


def _more(evaluation: Evaluation) -> dict[str, float]:
    if not evaluation.objectives:
        return {}
    return {f"extra_{k}": (k + 1) * evaluation.objectives["momentum"] + evaluation.design["length"] for k in range(3)}


def test_legends_of_the_flight_lie_beside_the_curves(data):
    with style():
        figure = next(k for k in FIGURES if k.name == "flight").draw(data)
        FigureCanvasAgg(figure).draw()
    for axes in figure.axes:
        assert not axes.get_legend().get_window_extent().overlaps(axes.bbox)


def test_commands_close_together_are_written_on_several_lines(data):
    study = type("Busy", (synthetic_run.Study,), {})()
    flight = next(iter(data.details.values())).flight
    details = {k: replace(d, flight=replace(flight, trajectory="trajectory_5")) for k, d in data.details.items()}
    with style():
        assert overlaps(next(k for k in FIGURES if k.name == "flight").draw(FigureData(data.run, details, study))) == []


def test_figures_are_written_as_png_and_pdf_without_touching_settings(data, tmp_path):
    import matplotlib as mpl

    before = dict(mpl.rcParams)
    paths = write_figures(data, tmp_path, names=("front", "convergence"))
    assert sorted(p.name for p in paths) == ["convergence.pdf", "convergence.png", "front.pdf", "front.png"]
    assert sorted(p.name for p in tmp_path.iterdir()) == sorted(p.name for p in paths)
    assert dict(mpl.rcParams) == before
    assert b"/FontFile2" in (tmp_path / "front.pdf").read_bytes()  # fonts are embedded


def test_the_front_figure_shows_the_front_and_the_original(data):
    with style():
        axes = next(k for k in FIGURES if k.name == "front").draw(data).axes[0]
    shown = {collection.get_label(): collection.get_offsets() for collection in axes.collections}
    assert np.allclose(shown["best compromise"], data.run.values[data.run.front][:, :2])
    assert np.allclose(shown["original"], data.run.baseline_vector[:2])
    assert np.allclose(shown["recommended"], data.run.values[data.run.recommended, :2])


@pytest.mark.parametrize("count", [0, 1])
def test_runs_without_a_front_leave_figures_out(tmp_path, count):
    infeasible = [e for e in synthetic_run.evaluations(60) if e.status == "infeasible"][:count]
    synthetic_run.write_run(tmp_path / "run", infeasible)
    empty = FigureData(read_report_data(tmp_path / "run", STUDY), {}, None)
    assert write_figures(empty, tmp_path / "figures") == ()


def test_the_close_up_shows_parts_and_jets(data):
    scene = robot_scene(STUDY, synthetic_run.BASELINE)
    joints, base = posture(data, data.run.baseline)
    bodies, near = close_up(scene, joints, base)
    assert 4 < len(near) < len(bodies)
