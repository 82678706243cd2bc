"""Tolerances: what a sample changes, that all designs get the same luck, and what a run makes of its samples."""

import numpy as np
import pytest

from codesign import load_study
from codesign.chain.scatter import made, sample_name, split_sample, tolerance_of
from codesign.errors import StudyError
from codesign.followup.tolerances import made_design
from codesign.problem.evaluation import Evaluation
from codesign.report.objections import objections
from codesign.report.tolerances import Tolerances
from codesign.study.config import TolerancesConfig
from codesign.transforms import rotation_from_rpy
from codesign.units import DEGREE

DESIGN = {"angle": 15.0, "distance": 42.0, "offset": 80.0, "length": 108.0}


@pytest.mark.parametrize(
    ("length", "wanted"), [(2, 0.1), (6, 0.1), (6.1, 0.2), (30, 0.2), (108, 0.3), (120, 0.3), (150, 0.5), (1000, 0.8)]
)
def test_lengths_have_the_tolerances_of_the_standard(length: float, wanted: float) -> None:
    """ISO 2768-m."""
    assert tolerance_of(length, "mm", TolerancesConfig()) == wanted


def test_a_length_beyond_the_standard_is_refused() -> None:
    """The table ends at two meters."""
    with pytest.raises(StudyError, match="2500 mm"):
        tolerance_of(2500.0, "mm", TolerancesConfig())


def test_a_sample_stays_within_the_tolerances_and_fills_them() -> None:
    """500 samples: lengths within 0.3 mm, a third of that as deviation, strength 4 %, jets within half a degree."""
    config = load_study("ironcub_paper").config
    lengths, strengths, tilts = [], [], []
    for number in range(500):
        changed, values = made(config, DESIGN, number)
        lengths.append(values["length"] - 108.0)
        strengths.append(changed.materials["ergal"].yield_strength_mpa / config.materials["ergal"].yield_strength_mpa)
        for before, after in zip(config.parts, changed.parts, strict=True):
            for old, new in zip(before.placements, after.placements, strict=True):
                for joint, attachment in new.joints.items():
                    first = rotation_from_rpy([a * DEGREE for a in old.joints[joint].interface_T_child.rpy_deg])
                    second = rotation_from_rpy([a * DEGREE for a in attachment.interface_T_child.rpy_deg])
                    tilts.append(np.degrees(np.arccos(np.clip((np.trace(first.T @ second) - 1) / 2, -1, 1))))
    assert np.abs(lengths).max() <= 0.3 + 1e-12
    assert np.std(lengths) == pytest.approx(0.1, rel=0.1)
    assert np.std(strengths) == pytest.approx(0.04, rel=0.1)
    assert 0.0 < max(tilts) <= 0.5 * np.sqrt(2) + 1e-9
    densities = [part.density_kg_m3 for part in made(config, DESIGN, 1)[0].parts]
    assert densities != [part.density_kg_m3 for part in config.parts]


def test_designs_are_made_with_the_same_luck() -> None:
    """The same sample changes two designs by the same share of their tolerances, and is the same when drawn again."""
    config = load_study("ironcub_paper").config
    _, one = made(config, DESIGN, 7)
    _, other = made(config, DESIGN | {"length": 130.0}, 7)
    assert (one["length"] - 108.0) / 0.3 == pytest.approx((other["length"] - 130.0) / 0.5)
    assert made(config, DESIGN, 7)[1] == one
    assert made(config, DESIGN, 8)[1] != one


def test_samples_have_names() -> None:
    """Trajectory and number, and none without."""
    assert split_sample(sample_name("envelope@3", 17)) == ("envelope@3", 17)
    assert split_sample("envelope") == ("envelope", None)
    assert split_sample("~4") == (None, 4)
    with pytest.raises(StudyError, match="whole number"):
        split_sample("envelope~x")


def evaluation(status: str, momentum: float, factor: float) -> Evaluation:
    """What one sample gave."""
    reason = None if status == "feasible" else "safety factor 9 below 10"
    return Evaluation(
        DESIGN,
        status,
        reason,
        {"momentum": momentum},
        parts={"rod": {"safety_factor": factor}},  # type: ignore[arg-type]
    )


def test_a_design_that_fails_too_often_is_not_recommended() -> None:
    """98 of 100 samples feasible: an objection that nothing but another design lifts; 99: none."""
    for bad, robust in ((1, True), (2, False)):
        samples = [evaluation("infeasible" if i < bad else "feasible", 1.0 + i, 12.0) for i in range(100)]
        found = made_design("recommended", DESIGN, samples)
        assert found.robust is robust
        assert found.share == pytest.approx(1 - bad / 100)
        assert found.numbers["momentum"].median == pytest.approx(50.5)
        kinds = objections(samples[-1], {}, found)
        assert bool(kinds) is not robust
        assert all(each.final for each in kinds)
        kept = Tolerances.from_json(Tolerances((found,), {"dimensions": "m"}).to_json())
        assert kept.of(DESIGN) == found
