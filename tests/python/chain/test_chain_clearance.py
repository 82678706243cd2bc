"""Clearances as part of the chain: reported for every flown design, a constraint where the study says so."""

import msgspec
import numpy as np
import pytest

import codesign
from codesign import dynamics
from codesign.chain import chain as pipeline
from codesign.chain.clearances import clearances, part_pieces
from codesign.chain.documents import flight_document, objective_families
from codesign.chain.flight import flight_settings, joint_names
from codesign.chain.judge import judge
from codesign.geometry.profile import Resolution
from codesign.parts import part as part_module
from codesign.units import MILLIMETER


@pytest.fixture(scope="module")
def flown():
    """Short rod and nearly flat bracket: turbines near the upper arms, chest plumes near the feet."""
    study = codesign.load_study("ironcub_paper")
    design = study.space.design((1, 48, 88, 50))
    config = study.configured(design)
    robot = pipeline.build_robot(study, design)
    model = dynamics.load_urdf(robot.to_text(), joints=joint_names(config.flight))
    log = dynamics.simulate_flight(model, flight_settings(config.flight, config.trajectories["envelope"]))
    return config, log, clearances(config, pipeline.build_parts(study, design, config), robot, [log])


def judged(config, log, found):
    """The verdict on a flight without parts."""
    flight = flight_document("envelope", [log], config.flight, 0.0) | ({"interference": found} if found else {})
    return judge(config, {"parts": {}, "flight": flight, "objective_families": objective_families([log])}, {})


def test_a_flown_design_reports_its_nearest_pairs_and_plumes(flown):
    _, _, found = flown
    nearest = found["bodies"][0]
    assert set(nearest["links"]) <= {"l_upper_arm", "r_upper_arm", "l_arm_jet_turbine", "r_arm_jet_turbine"}
    assert nearest["clearance"] == found["body_clearance"] < -0.015
    assert found["plumes"][0]["jet"].startswith("chest_")
    assert found["plumes"][0]["link"].endswith(("ankle_2", "foot_rear"))
    assert found["plume_clearance"] < -0.02
    assert [pair["clearance"] for pair in found["bodies"]] == sorted(pair["clearance"] for pair in found["bodies"])


def test_clearances_are_no_constraint_unless_the_study_says_so(flown):
    config, log, found = flown
    verdict = judged(config, log, found)
    assert verdict.constraints["body_clearance"] == found["body_clearance"]
    assert verdict.constraints["plume_clearance"] == found["plume_clearance"]
    assert verdict.status == "feasible" and not any(verdict.violations.values())


def test_a_clearance_below_the_studys_limit_is_a_violation_with_a_reason(flown):
    config, log, found = flown
    limits = msgspec.structs.replace(config.constraints, body_clearance_min_mm=2.0, plume_clearance_min_mm=-100.0)
    strict = msgspec.structs.replace(config, constraints=limits)
    verdict = judged(strict, log, found)
    assert verdict.violations["body_clearance"] == pytest.approx((0.002 - found["body_clearance"]) / 0.01)
    assert verdict.violations["plume_clearance"] == 0.0
    assert verdict.status == "infeasible" and "body clearance -20" in (verdict.reason or "")


def test_a_study_without_the_section_measures_nothing(flown):
    config, log, _ = flown
    silent = msgspec.structs.replace(config, interference=None)
    assert clearances(silent, {}, None, [log]) == {}
    assert "body_clearance" not in judged(silent, log, {}).constraints


def test_clearances_take_the_mesh_that_the_mass_made(monkeypatch):
    study = codesign.load_study("ironcub_paper")
    parts = study.build_parts(study.space.from_indices((33, 7, 11, 13))).values()
    for part in parts:
        part.mass_properties()
    monkeypatch.setattr(part_module, "build_solid", None)  # no other is made
    pieces = [np.vstack(part_pieces(part, 8)) for part in parts]
    monkeypatch.undo()
    for part, points in zip(parts, pieces, strict=True):
        fine = part.solid(Resolution(512)).points * MILLIMETER
        assert np.abs(np.ptp(points, axis=0) - np.ptp(fine, axis=0)).max() < 1.2e-3  # twice 0.6 mm
