"""The studies of the iRonCub: as published, flown as a robot would fly, with loads and materials, with flown loads."""

import tomllib
from dataclasses import replace

import numpy as np
import pytest

from codesign import _core, load_study
from codesign import dynamics as dyn
from codesign.chain.chain import stress_settings
from codesign.chain.flight import find_trajectory, flight_seeds, flight_settings, joint_names
from codesign.parts.load_case import part_case
from codesign.studies.ironcub.bracket import COUNTERBORE_RADIUS, SEAT_HOLES
from codesign.study.loading import STUDIES

DESIGN = (4, 90, 98, 122)


def differences(own: dict, base: dict, place: str = "") -> set[str]:
    """Places of the keys that one study states differently, joint groups without their names."""
    found = set()
    for key, value in own.items():
        here = f"{place}.{key}".lstrip(".")
        if isinstance(value, dict) and isinstance(base.get(key), dict):
            found |= differences(value, base[key], here)
        elif value != base.get(key):
            found.add(here)
    return found


def test_the_robust_study_states_and_explains_every_difference():
    own = tomllib.loads((STUDIES / "ironcub_robust" / "study.toml").read_text())
    base = tomllib.loads((STUDIES / "ironcub_paper" / "study.toml").read_text())
    assert own["extends"] == "ironcub_paper"
    groups = own["flight"].pop("joint_groups")
    changed = differences(own, base) | {f"flight.joint_groups.{key}" for group in groups for key in group}
    page = (STUDIES.parents[2] / "docs" / "trust.md").read_text()
    told = {place for place in changed if place.rpartition(".")[2] in page}
    assert changed - told <= {"extends", "without", "name", "title", "flight.joint_groups.name"}


def test_both_have_the_same_parts_and_variables():
    default, published = load_study("ironcub_robust").config, load_study("ironcub_paper").config
    assert default.variables == published.variables
    assert [part.shape for part in default.parts] == [part.shape for part in published.parts]
    assert default.robot == published.robot


@pytest.fixture(scope="module")
def flown():
    study = load_study("ironcub_robust")
    config = study.configured(study.space.design(DESIGN))
    settings = flight_settings(config.flown, find_trajectory(config, "envelope"))
    settings.duration = 2.0
    model = dyn.load_urdf(study.build_robot(DESIGN), joints=joint_names(config.flown))
    return model, settings, dyn.simulate_flights(model, settings, flight_seeds(config, "envelope"))


def test_the_robust_study_starts_in_a_hover_inside_the_robots_joint_ranges(flown):
    model, settings, _ = flown
    start = dyn.fitted_settings(model, settings)
    low, high = np.array([[model.joint_limits[name][end] for end in ("lower", "upper")] for name in settings.joints]).T
    assert (start.limits.joint_lower == low).all() and (start.limits.joint_upper == high).all()
    scale = start.limits.joint_range_scale
    assert (start.initial_joints >= scale * low).all() and (start.initial_joints <= scale * high).all()
    pose, joints = start.base_pose, start.initial_joints
    left = dyn.gravity_forces(model, pose, joints)[:6]
    for jet, thrust in zip(settings.actuators, start.initial_thrusts, strict=True):
        world_T_jet = dyn.frame_pose(model, pose, joints, jet.frame)
        force = thrust * world_T_jet[:3, :3] @ jet.axis
        left -= np.concatenate([force, np.cross(world_T_jet[:3, 3] - pose[:3, 3], force)])
    assert np.abs(left).max() < 1e-9


def test_the_robust_study_flies_three_paired_draws_of_the_unknown(flown):
    _, settings, logs = flown
    assert len(logs) == 3 and all(log.completed for log in logs)
    assert settings.disturbances.thrust_deviation == settings.disturbances.mass_deviation == 0.01
    assert all(0.05 < log.fuel_burnt < 0.08 for log in logs)
    shares = [np.abs(log.unmodeled_force[:, :3]).max() for log in logs]
    assert min(shares) > 2.0


def test_the_default_study_flies_as_the_robust_one():
    default, robust = load_study().config, load_study("ironcub_robust").config
    assert default.name == "ironcub"
    for section in ("flight", "trajectories", "constraints", "interference", "objectives", "robot"):
        assert getattr(default, section) == getattr(robust, section)


def test_parts_of_the_default_study_are_of_one_material_which_is_a_choice():
    study = load_study()
    masses = {}
    for name, density in (("ergal", 2800.0), ("ti-6al-4v", 4430.0)):
        design = study.space.design([*DESIGN, name, name])
        parts = study.build_parts(design)
        assert {part.density for part in parts.values()} == {density}
        masses[name] = dyn.load_urdf(study.build_robot(design), joints=joint_names(study.config.flown)).total_mass
        for part in parts:
            assert stress_settings(study.configured(design), part).material.name == name
    assert 0.5 < masses["ti-6al-4v"] - masses["ergal"] < 2.0  # two brackets, two supports: 1.7 kg of Ergal


def test_the_study_of_flown_loads_is_the_default_one_and_a_case_more():
    default, strength = load_study(), load_study("ironcub_strength")
    assert strength.config.variables == default.config.variables
    for part, more in zip(default.config.parts, strength.config.parts, strict=True):
        assert more.cases[:-1] == part.cases
        assert (more.cases[-1].name, more.masses) == ("flown", part.masses)
        assert [case.safety_factor_min for case in more.cases] == [10.0, 10.0, 1.0, 2.0, 2.0, 2.0, 10.0]


def test_the_seat_of_the_default_studys_bracket_decides_and_is_analyzed():
    """A turbine's thrust bends the slab, most at the counterbores; without: 21, at the crease."""
    study = load_study()
    design = study.space.design([*DESIGN, "ergal", "ti-6al-4v"])
    bracket = study.build_parts(design)["jetpack_bracket"]
    settings = stress_settings(study.configured(design), bracket.name)
    axis = [case for case in settings.cases if case.name == "axis"]
    searched = _core.analyze_part(part_case(bracket, replace(settings, cases=axis, masses=()))).result
    assert searched.safety_factor == pytest.approx(15.6, rel=0.04)  # full geometry, fine mesh
    across = np.asarray(searched.peak_position) - bracket.seat_center
    x, y, z = across @ bracket.slab_direction, across[1], across @ bracket.slab_normal
    to_axis = min(np.hypot(1e3 * x - hole[0], 1e3 * abs(y) - hole[1]) for hole in SEAT_HOLES)
    assert (to_axis, 1e3 * z) == (pytest.approx(COUNTERBORE_RADIUS, abs=0.3), pytest.approx(bracket.thickness, abs=0.5))
