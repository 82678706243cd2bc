"""Ten designs, corners of the grid among them, as other programs read them: the robot that Pinocchio reads."""

import itertools
from collections.abc import Sequence

import pytest

from codesign.chain.study import load_study
from exported_robots import ORIGINAL, Exported, export_robot, random_design
from robot_readers import READERS, contacts_in_flight, differences, usd_differences

STUDY, POSTURES, FLOWN = "ironcub_paper", 5, 1.0  # s
WITHIN = {"mass": 1e-12, "com": 1e-12, "inertia": 1e-12, "frames": 1e-12, "gravity": 1e-9}
WITHIN_NEWTON = {"mass": 2e-5, "com": 2e-6, "inertia": 2e-6, "frames": 3e-5}  # single precision, also of its angles
WITHIN_USD = {"mass": 1e-6, "com": 1e-6, "inertia": 1e-6, "frames": 1e-6, "turned": 5e-6}  # single precision


def ten_designs() -> list[dict[str, float]]:
    """The original, seven corners of the grid, every variable at both ends, and two at random."""
    variables = load_study(STUDY).space.variables
    ends = [(v.value(0), v.value(v.levels - 1)) for v in variables]
    corners = [dict(zip([v.name for v in variables], corner, strict=True)) for corner in itertools.product(*ends)]
    return [ORIGINAL[STUDY], *(corners[k] for k in (0, 3, 5, 6, 9, 10, 15)), *(random_design(STUDY, k) for k in (1, 2))]


@pytest.fixture(scope="module")
def ten(tmp_path_factory) -> Sequence[Exported]:
    folder = tmp_path_factory.mktemp("ten")
    return [export_robot(STUDY, theta, folder / str(k) / "robot", FLOWN) for k, theta in enumerate(ten_designs())]


@pytest.mark.parametrize("reader", READERS)
def test_masses_inertias_frames_and_gravity(ten, reader):
    for exported in ten:
        found = differences(exported, READERS[reader][1](exported), POSTURES)
        within = WITHIN_NEWTON if reader.startswith("Newton") else WITHIN
        assert {name: value for name, value in found.items() if not value < within[name]} == {}


@pytest.mark.parametrize("reader", [name for name in READERS if name.startswith(("MuJoCo", "Drake"))])
def test_nothing_collides_where_it_flies(ten, reader):
    assert [contacts_in_flight(exported, READERS[reader][1](exported)) for exported in ten] == [0] * len(ten)


def test_usd(ten, tmp_path):
    for k, exported in enumerate(ten):
        found = usd_differences(exported, tmp_path / str(k))
        assert {name: value for name, value in found.items() if not value < WITHIN_USD[name]} == {}
