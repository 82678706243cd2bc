"""Flown loads: the wrench on a seat against the flight's equations, stresses over a flight against direct solves."""

import shutil
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from codesign import _core, fem, load_study
from codesign import dynamics as dyn
from codesign.chain import chain, flown
from codesign.chain.flight import find_trajectory, flight_settings
from codesign.chain.study import Study
from codesign.errors import StudyError
from codesign.parts.load_case import CaseSettings, PushedFace, part_case, placed
from codesign.robot.description import RobotDescription
from codesign.robot.motion import MotionHistory, Thrust, descendants
from codesign.study.loading import STUDIES

DESIGN = {"angle": 15, "distance": 42, "offset": 80, "length": 108}
STUDY = """
extends = "ironcub_paper"
name = "flown"
without = ["parts.jetpack_bracket.loads", "parts.forearm_support.loads"]

[flight]
duration_s = 2.0

[[parts]]
name = "jetpack_bracket"
cases = [
  { name = "thrust", loads = [{ face = "seat", pressing_n = 250.0 }] },
  { name = "flown", flown = { turbine_seat = "seat" }, safety_factor_min = 20.0 },
]

[[parts]]
name = "forearm_support"
cases = [
  { name = "push", loads = [{ face = "seat", pressing_n = 250.0 }] },
  { name = "flown", flown = { turbine = "seat" }, safety_factor_min = 20.0 },
]
"""


def study_with_flown_loads(folder: Path, changes: Mapping[str, str] | None = None) -> Study:
    """The shipped study with a flown case on both parts and a flight of two seconds."""
    text = STUDY
    for old, new in (changes or {}).items():
        assert old in text
        text = text.replace(old, new)
    shutil.copytree(STUDIES / "ironcub", folder / "ironcub")  # the robot is beside, as it is for shipped studies
    (folder / "flown").mkdir()
    (folder / "flown" / "study.toml").write_text(text, encoding="utf-8")
    return load_study(folder / "flown")


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Study:
    return study_with_flown_loads(tmp_path_factory.mktemp("flown"))


Flown = tuple[MotionHistory, list[Thrust], dyn.FlightLog, dyn.FlightSettings, RobotDescription]


@pytest.fixture(scope="module")
def flight(study: Study) -> Flown:
    """Motion, jets, log, settings and robot of the design's flight."""
    robot = RobotDescription.from_text(study.build_robot(DESIGN))
    settings = flight_settings(study.config.flown, find_trajectory(study.config, "envelope"))
    log = dyn.simulate_flight(dyn.load_urdf(robot.to_text(), joints=settings.joints), settings)
    motion = flown.motion_history(robot, settings.joints, log)
    return motion, flown.thrusts(settings, log, len(motion.positions)), log, settings, robot


def test_nothing_pushes_on_the_whole_robot(flight: Flown) -> None:
    """Thrust and weight are used up by the accelerations of all links: Newton and Euler for the free robot."""
    motion, jets, _, _, robot = flight
    force, moment = motion.wrench_on(motion.base.position, robot.link_names, jets)
    assert np.abs(force).max() < 1e-9
    assert np.abs(moment).max() < 1e-9


def test_the_moment_about_a_joint_is_its_torque(flight: Flown) -> None:
    """What hangs on the elbows pushes against the torque that holds it, at every sample."""
    motion, jets, log, settings, robot = flight
    for name in ("l_elbow", "r_elbow", "torso_yaw"):
        joint, column = robot.joint(name), settings.joints.index(name)
        child = motion.motion(joint.child)
        _, moment = motion.wrench_on(child.position, descendants(robot, name), jets)
        along = np.einsum("nij,j,ni->n", child.rotation, np.asarray(joint.axis), moment)
        np.testing.assert_allclose(along, -log.torque[: len(along), column], atol=1e-9)


def test_sampled_instants_are_direct_solutions(study: Study, flight: Flown) -> None:
    """20 instants of a flight, both arms: peak, place and displacement to 1e-9; none exceeds the decided one."""
    motion, jets, log, _, _ = flight
    part = study.build_parts(DESIGN)["forearm_support"]
    placements = next(p.placements for p in study.config.parts if p.name == "forearm_support")
    settings = placed(part, chain.stress_settings(study.config, "forearm_support"))
    (case,) = settings.flown
    native = part_case(part, settings)
    analysis = _core.analyze_part(native)
    system = _core.fem.StaticSystem(analysis.mesh, native.material, native.supports, native.settings)
    (responses,) = analysis.responses
    loads = list(flown.flown_loads(case, placements, part.interfaces(), motion, jets, log.step))
    assert [each.link for each in loads] == ["l_forearm", "r_forearm"]
    decided = flown.decide(responses, loads)
    rng = np.random.default_rng(1)
    for each in loads:
        for instant in rng.integers(0, len(each.time), 10):
            factors = each.factors[instant]
            asked = [
                fem.AffineTraction("seat", factors[:3], case.points[0], factors[3:6]),
                fem.Acceleration(factors[6:9], factors[9:].reshape(3, 3)),
            ]
            direct = system.solve([load.native(None) for load in asked])
            summed = responses.at(factors)
            assert summed.peak_stress == pytest.approx(direct.peak_stress, rel=1e-9)
            np.testing.assert_allclose(summed.peak_position, direct.peak_position, atol=1e-9)
            size = np.abs(direct.displacement).max()
            np.testing.assert_allclose(summed.displacement, direct.displacement, atol=1e-9 * size)
            assert direct.peak_stress <= decided.result.peak_stress


def test_a_mirrored_part_feels_the_mirrored_load(study: Study, flight: Flown) -> None:
    """Both arms hold the turbine alike: in a symmetric instant the loads in part axes are equal."""
    motion, jets, log, _, _ = flight
    part = study.build_parts(DESIGN)["forearm_support"]
    config = next(p for p in study.config.parts if p.name == "forearm_support")
    (case,) = placed(part, chain.stress_settings(study.config, "forearm_support")).flown
    left, right = flown.flown_loads(case, config.placements, part.interfaces(), motion, jets, log.step)
    start = np.abs(left.factors[0, :6] - right.factors[0, :6])
    assert start.max() < 0.02 * np.abs(left.factors[0, :6]).max()


def test_the_flown_case_is_in_the_document_and_governs(study: Study) -> None:
    """Case, time and link are told; the case nearest to its limit gives the part its numbers."""
    evaluation = study.evaluate(DESIGN)
    for name, links in (("jetpack_bracket", "chest_"), ("forearm_support", "_forearm")):
        part = evaluation.parts[name]
        case = part["cases"]["flown"]
        assert 0.0 <= case["time"] <= 2.0
        assert links in case["link"]
        reserve = {
            label: each["safety_factor"] / {"thrust": 10.0, "push": 10.0, "flown": 20.0}[label]
            for label, each in part["cases"].items()
        }
        assert part["load_case"] == min(reserve, key=reserve.__getitem__)
        assert part["safety_factor"] == part["cases"][part["load_case"]]["safety_factor"]
        assert f"parts.{name}.cases.flown.safety_factor" in evaluation.constraints


def test_the_whole_bracket_is_twice_its_half(study: Study) -> None:
    """Under the published load: peak within 2 %, work within 1 %; an oblique load is taken by the whole part alone."""
    part = study.build_parts(DESIGN)["jetpack_bracket"]
    settings = replace(chain.stress_settings(study.config, "jetpack_bracket"), flown=())
    oblique = CaseSettings("oblique", (PushedFace("seat", (50.0, 100.0, 0.0)),))
    half = _core.analyze_part(part_case(part, settings))
    whole = _core.analyze_part(part_case(part, replace(settings, cases=(*settings.cases, oblique))))
    assert whole.mesh.nodes[:, 1].min() == pytest.approx(-half.mesh.nodes[:, 1].max())
    assert whole.results[0].peak_stress == pytest.approx(half.results[0].peak_stress, rel=0.02)
    assert whole.results[0].work == pytest.approx(half.results[0].work, rel=0.01)
    assert whole.results[1].peak_stress > 0.0


def test_the_answers_of_a_part_are_kept(study: Study, monkeypatch: pytest.MonkeyPatch) -> None:
    """A known part is not meshed again for another flight in the same process."""
    from codesign.storage.cache import MemoryCache

    cache = MemoryCache()
    first = study.evaluate(DESIGN, cache=cache)
    seen: list[int] = []
    original = chain.compute

    def counted(*arguments: object) -> object:
        seen.append(len(arguments[2]))  # type: ignore[arg-type]
        return original(*arguments)  # type: ignore[arg-type]

    monkeypatch.setattr(chain, "compute", counted)
    second = study.evaluate(DESIGN, cache=cache)
    assert seen == [0]
    assert second.parts["forearm_support"]["cases"] == first.parts["forearm_support"]["cases"]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('{ turbine = "seat" }', '{ turbin = "seat" }', "turbine"),
        ('{ turbine = "seat" }', '{ turbine = "mount" }', "held"),
        ('{ name = "push", loads = [{ face = "seat", pressing_n = 250.0 }] },', "", "one case with loads of its own"),
    ],
)
def test_what_is_wrong_with_a_flown_case_is_told(tmp_path: Path, old: str, new: str, said: str) -> None:
    """A face or interface that is not there, a held seat, no case of a lost flight."""
    with pytest.raises(StudyError, match=said):
        study_with_flown_loads(tmp_path, {old: new})
