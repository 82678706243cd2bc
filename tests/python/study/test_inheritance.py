"""Studies that state only what they do differently from another."""

from pathlib import Path

import pytest

from codesign import load_study
from codesign.errors import StudyError
from codesign.study import new_study

BASE = "study"  # `codesign new` beside the extending study


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    new_study(tmp_path / BASE)
    for module in (tmp_path / BASE).glob("*.py"):
        (tmp_path / module.name).write_text(module.read_text())
    for urdf in (tmp_path / BASE).glob("*.urdf"):
        (tmp_path / urdf.name).write_text(urdf.read_text())
    return tmp_path


def extending(folder: Path, text: str, name: str = "mine.toml") -> Path:
    path = folder / name
    path.write_text(f'extends = "{BASE}"\n{text}')
    return path


def test_states_only_what_differs(folder: Path) -> None:
    base = load_study(folder / BASE)
    study = load_study(
        extending(folder, 'name = "mine"\n[flight]\nduration_s = 1.6\n[flight.gains]\nobserver_hz = 5.0\n')
    )
    assert (study.name, study.config.flown.duration_s, study.config.flown.gains.observer_hz) == ("mine", 1.6, 5.0)
    assert study.config.flown.step_s == base.config.flown.step_s
    assert study.config.parts == base.config.parts
    assert study.space.levels == base.space.levels
    assert study.hash != base.hash


def test_lists_of_named_tables_are_merged_by_name_and_keys_can_be_left_out(folder: Path) -> None:
    base = load_study(folder / BASE)
    part, group = base.config.parts[0].name, base.config.flown.joint_groups[0].name
    study = load_study(
        extending(
            folder,
            f'without = ["flight.joint_groups.{group}.ranges_deg", "baseline"]\n'
            f'[[parts]]\nname = "{part}"\ndensity_kg_m3 = 1000.0\n'
            f'[[flight.joint_groups]]\nname = "{group}"\nrotor_inertia_kg_m2 = 0.1\n',
        )
    )
    assert study.config.parts[0].density_kg_m3 == 1000.0
    assert study.config.parts[0].placements == base.config.parts[0].placements
    changed = study.config.flown.joint_groups[0]
    assert (changed.rotor_inertia_kg_m2, changed.ranges_deg) == (0.1, [])
    assert changed.joints == base.config.flown.joint_groups[0].joints
    assert study.baseline is None


def test_is_loaded_anew_when_the_extended_study_changes(folder: Path) -> None:
    path = extending(folder, 'name = "mine"\n')
    before = load_study(path)
    file = folder / BASE / "study.toml"
    file.write_text(file.read_text().replace("attitude_proportional = ", "attitude_proportional = 1"))
    after = load_study(path)
    assert after.config.flown.gains.attitude_proportional != before.config.flown.gains.attitude_proportional
    assert after.hash != before.hash


def test_refuses_circles_and_places_that_are_not_there(folder: Path) -> None:
    with pytest.raises(StudyError, match=r"mine\.toml: without: 'flight\.gain': the extended study has no such key"):
        load_study(extending(folder, 'without = ["flight.gain"]\n'))
    (folder / "worse.toml").write_text('extends = "other"\n')
    with pytest.raises(
        StudyError,
        match="extends: 'other': no such study; shipped studies: gimbal_quad, hexarotor, ironcub, ironcub_paper",
    ):
        load_study(folder / "worse.toml")
    (folder / "a.toml").write_text('extends = "b.toml"\n')
    (folder / "b.toml").write_text('extends = "a.toml"\n')
    with pytest.raises(StudyError, match="studies extend each other in a circle"):
        load_study(folder / "a.toml")
