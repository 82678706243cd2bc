"""Sobol' indices against their closed form on the grid."""

import numpy as np
import pytest

from codesign.followup.sensitivity import saltelli_grid, sensitivity
from fake_study import study


def test_indices_of_an_additive_function_are_its_variance_shares(tmp_path) -> None:
    """near = Σ (x_i − 0.1)² / 3 with x_i uniform on its grid: no interactions, shares known exactly."""
    fake = study(levels=[5, 3, 2], unconstrained=True)
    variances = [np.var((np.linspace(0.0, 1.0, levels) - 0.1) ** 2) for levels in fake.space.levels]
    shares = np.array(variances) / sum(variances)
    near = sensitivity(fake, 256, out=tmp_path / "run", outputs=["objectives.near"], cache=None)[0]
    assert near.variables == ("a", "b", "c")
    assert near.first == pytest.approx(shares, abs=0.03)  # 256 quasi-random blocks
    assert near.total == pytest.approx(shares, abs=0.03)
    assert (near.samples, near.asked) == (256, 256)


def test_blocks_without_the_output_are_left_out_and_counted(tmp_path) -> None:
    sampled = saltelli_grid(study(levels=[5, 3, 2]).space, 16, 1)[0]
    fake = study(levels=[5, 3, 2], faults={",".join(map(str, sampled)): "raise"})
    results = sensitivity(fake, 16, out=tmp_path / "run", cache=None)
    near, far, margin = results
    assert [result.output for result in results] == ["objectives.far", "objectives.near", "constraints.margin"]
    assert near.samples == far.samples < margin.samples < 16
    again = sensitivity(fake, 16, out=tmp_path / "run", cache=None)
    assert again == results
    with pytest.raises(ValueError, match="another run"):
        sensitivity(fake, 32, out=tmp_path / "run", cache=None)


def test_constant_outputs_have_no_indices(tmp_path) -> None:
    fake = study(levels=[3, 1, 1])
    (result,) = sensitivity(fake, 4, out=tmp_path / "run", outputs=["violations.margin"], cache=None)
    assert result.first is None
    with pytest.raises(ValueError, match="no evaluation has a number"):
        sensitivity(fake, 4, out=tmp_path / "run", outputs=["objectives.missing"], cache=None)


def test_sample_sizes_are_powers_of_two() -> None:
    assert len(saltelli_grid(study().space, 8, 1)) == 8 * 5
    with pytest.raises(ValueError, match="power of two"):
        saltelli_grid(study().space, 12, 1)
