"""What the report says of a study is that study's: no word of another robot, groups, loads and materials by name."""

import re
from pathlib import Path

import msgspec
import numpy as np
import pytest

import codesign
from codesign.chain.study import load_study
from codesign.report.details import flight_history
from codesign.report.reading import description
from codesign.report.study_words import flight_words, load_words, objective_quantities, part_words
from codesign.study.load_config import LoadConfig

PACKAGE = Path(codesign.__file__).parent
ROBOT_WORDS = (
    r"ironcub|jetpack|torso|forearm|bracket|chest|humanoid|\barms?\b|\bleg\b|elbow|ergal|\bstruts?\b|gimbal|\b42 s\b|"
    r"\b42\.0\b"
)
WINGS = ("report", "viewer", "chain", "problem", "followup")


@pytest.mark.parametrize("wing", WINGS)
def test_the_engine_speaks_of_no_robot(wing):
    found = []
    for path in sorted((PACKAGE / wing).rglob("*")):
        if path.suffix not in (".py", ".js", ".html", ".css"):
            continue
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if (
                re.search(ROBOT_WORDS, line, re.IGNORECASE)
                and ">>>" not in line
                and "`" not in line
                and "def load_study" not in line
            ):
                found.append(f"{path.name}:{number}: {line.strip()}")
    assert found == []


def meanings(study: str) -> dict[str, str]:
    config = load_study(study).config
    return {q.key: q.meaning for q in objective_quantities(config.objectives.keys, config)}


def test_joint_groups_are_named_with_their_weights():
    assert "gimbals counted once." in meanings("gimbal_quad")["joint_velocity"]
    said = meanings("ironcub_paper")["joint_velocity"]
    assert "torso counted twice, left arm counted once and right arm counted once" in said
    assert "left leg and right leg not counted" in said


def test_momentum_says_what_is_summed():
    (momentum,) = (q for q in objective_quantities(["momentum"], None))
    assert momentum.unit == "kg·m/s + kg·m²/s"
    assert "linear" in momentum.meaning
    assert "angular" in momentum.meaning


def test_a_load_case_names_load_face_and_support():
    load = part_words(load_study("gimbal_quad").config)["strut"].load
    assert load.startswith("250\u202fN pressing on face seat, face mount held")


@pytest.mark.parametrize(
    ("load", "said"),
    [
        ({"face": "seat", "pressing_n": 250.0}, "250\u202fN pressing on face seat"),
        ({"face": "seat", "moment_n_m": (0.0, 0.0, 2.0)}, "(0, 0, 2)\u202fN\u202fm on face seat"),
        (
            {"face": "seat", "force_n": (1.0, 0.0, 0.0), "moment_n_m": (0.0, 0.0, 2.0), "point_mm": (5.0, 0.0, 0.0)},
            "(1, 0, 0)\u202fN with (0, 0, 2)\u202fN\u202fm at (5, 0, 0)\u202fmm on face seat",
        ),
        ({"acceleration_m_s2": (0.0, 0.0, -9.81)}, "acceleration (0, 0, -9.81)\u202fm/s²"),
    ],
)
def test_every_kind_of_load_has_its_unit(load, said):
    assert load_words(LoadConfig(**load)) == said


def test_a_density_that_is_not_the_materials_is_said():
    known = part_words(load_study("ironcub_paper").config)
    assert known["jetpack_bracket"].warning == ""
    assert "4410\u202fkg/m³ instead of 2800" in known["forearm_support"].warning
    assert "weighs 63\u202f% of the mass shown" in known["forearm_support"].warning
    assert "yield strength 462\u202fMPa" in known["forearm_support"].material


def test_a_flight_is_described_by_its_own_duration_and_step():
    assert "20\u202fs with 4 jets, simulated in steps of 8\u202fms" in flight_words(load_study("gimbal_quad").config)
    assert flight_words(load_study("ironcub_paper").config).startswith("One calm flight of 42\u202fs")
    assert flight_words(load_study("ironcub_robust").config).startswith("Means of 3 disturbed flights of 42\u202fs")


def test_a_flight_without_counted_joint_groups_has_a_history():
    rows = 5
    log = msgspec.defstruct("Log", ["time", "com", "com_reference", "base_rotation", "rotation_reference", "velocity",
        "joint_velocity_command", "thrust", "base_position", "joint_positions", "qp_iterations", "active_bounds"])(
        np.arange(rows), np.zeros((rows, 3)), np.zeros((rows, 3)), np.tile(np.eye(3).ravel(), (rows, 1)),
        np.tile(np.eye(3).ravel(), (rows, 1)), np.zeros((rows, 7)), np.zeros((rows, 1)), np.zeros((rows, 4)),
        np.zeros((rows, 3)), np.zeros((rows, 1)), np.zeros((rows, 2)), np.zeros(rows))  # fmt: skip
    history = flight_history(log, "hover", ("a", "b", "c", "d"), ("j",), {})
    assert history["joint_velocity_error"].shape == (rows, 0)


def test_what_a_design_carries_and_is_asked_is_that_designs(tmp_path):
    """A choice that sets the carried mass, and a variable that sets a limit, change the words of each design."""
    study = load_study("hexarotor")
    designs = [dict(study.baseline) | {"propeller": name} for name in study.space.variables[0].values]
    describe = description(study)
    for design in designs:
        (mass,) = study.configured(design).parts[0].masses
        said = f"{mass.mass_kg:g}\u202fkg on face seat"
        assert said in describe(design).parts["arm"].carried
        assert said in describe(design).parts["arm"].load
    assert len({describe(design).parts["arm"].load for design in designs}) == len(designs)


def test_a_study_with_other_variables_describes_an_old_design_as_it_stands():
    study = load_study("hexarotor")
    assert description(study)({"gone": 1.0}).parts == part_words(study.config)
