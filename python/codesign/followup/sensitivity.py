"""Which design variables matter: Sobol' indices of objectives and constraints over the design grid."""

from __future__ import annotations

import importlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Unpack

import numpy as np
import numpy.typing as npt

from codesign.errors import ExecutionError
from codesign.problem.design_space import DesignSpace
from codesign.problem.evaluation import Evaluation
from codesign.search.base import Grid
from codesign.search.optimization import Resources, StudyLike, load_problem, resume, run_search
from codesign.search.sampling import grid_points
from codesign.search.settings import Settings
from codesign.storage.database import DATABASE
from codesign.storage.runs import load_run

RESAMPLES = 200  # of the bootstrap behind the confidence intervals


@dataclass(frozen=True, slots=True)
class Sensitivity:
    """Sobol' indices of one output, one value per design variable, in order.

    first: share of the output's variance that the variable explains alone. total: with all its interactions; near 0
    means that the variable may be fixed. Each with the half-width of its 95 % interval. None if the output is constant.
    samples: blocks of the sample that have the output in all their designs, out of `asked`.
    """

    output: str
    variables: tuple[str, ...]
    first: tuple[float, ...] | None
    first_interval: tuple[float, ...] | None
    total: tuple[float, ...] | None
    total_interval: tuple[float, ...] | None
    samples: int
    asked: int


def sensitivity(
    study: StudyLike,
    samples: int = 128,
    *,
    out: str | Path,
    seed: int = 1,
    outputs: Sequence[str] | None = None,
    **resources: Unpack[Resources],
) -> list[Sensitivity]:
    """Evaluates a Saltelli sample of the grid (kept in `out`, resumable) and computes Sobol' indices.

    Args:
        samples: blocks, a power of two; each costs (variables + 2) evaluations, less what repeats.
        outputs: `objectives.momentum`, `constraints.safety_factor`, `parts.bracket.mass`, …; None: all objectives and
            constraints.

    A block with a design that lacks the output (failed, or a lost flight) is left out of it: the indices then describe
    the rest of the grid, and `samples` says how much that is.
    Raises: as `optimization.optimize`; ExecutionError if SALib is missing; ValueError for wrong samples or outputs.
    """
    problem = load_problem(study)
    grids = saltelli_grid(problem.space, samples, seed)
    if (Path(out) / DATABASE).exists():
        run = load_run(out)
        if run.settings != Settings.listing(grids).document():
            raise ValueError(f"{out}: holds another run than this sample")
        run = resume(out, study=problem, **resources)
    else:
        run = run_search(problem, Settings.listing(grids), out, **resources)
    return analyze(run.space, grids, {r.grid: r.evaluation for r in run.search_records}, outputs, seed)


def saltelli_grid(space: DesignSpace, samples: int, seed: int) -> list[Grid]:
    """The sample as grid points, repetitions included: `samples` blocks of (variables + 2)."""
    if samples < 2 or samples & (samples - 1):
        raise ValueError(f"samples = {samples}: a power of two is needed")
    unit = _salib("sample.sobol").sample(_definition(space), samples, calc_second_order=False, scramble=True, seed=seed)
    return grid_points(np.asarray(unit), space.levels)


def analyze(
    space: DesignSpace,
    grids: Sequence[Grid],
    evaluations: dict[Grid, Evaluation],
    outputs: Sequence[str] | None = None,
    seed: int = 1,
) -> list[Sensitivity]:
    """Sobol' indices from the evaluations of a Saltelli sample."""
    if outputs is None:
        known = {
            f"{group}.{name}"
            for evaluation in evaluations.values()
            for group in ("objectives", "constraints")
            for name in getattr(evaluation, group)
        }
        outputs = sorted(known, key=lambda name: (not name.startswith("objectives"), name))
    return [_indices(space, output, _values(grids, evaluations, output), seed) for output in outputs]


def _indices(space: DesignSpace, output: str, values: npt.NDArray[np.float64], seed: int) -> Sensitivity:
    block = len(space.variables) + 2
    blocks = values.reshape(-1, block)
    complete = blocks[np.isfinite(blocks).all(axis=1)]
    counts = (len(complete), len(blocks))
    if len(complete) < 2 or np.ptp(complete) == 0.0:
        return Sensitivity(output, space.names, None, None, None, None, *counts)
    centered = complete.ravel() - complete.mean()
    result = _salib("analyze.sobol").analyze(
        _definition(space), centered, calc_second_order=False, num_resamples=RESAMPLES, seed=seed
    )
    first, first_interval, total, total_interval = (
        tuple(float(value) for value in result[name]) for name in ("S1", "S1_conf", "ST", "ST_conf")
    )
    return Sensitivity(output, space.names, first, first_interval, total, total_interval, *counts)


def _values(grids: Sequence[Grid], evaluations: dict[Grid, Evaluation], output: str) -> npt.NDArray[np.float64]:
    """The output of each grid point, NaN where there is none."""
    values = np.full(len(grids), np.nan)
    for i, grid in enumerate(grids):
        evaluation = evaluations.get(grid)
        if evaluation is not None and evaluation.status != "failed":
            value: Any = evaluation.to_dict()
            for key in output.split("."):
                value = value.get(key) if isinstance(value, dict) else None
            if isinstance(value, int | float):
                values[i] = value
    if np.isnan(values).all():
        raise ValueError(f"no evaluation has a number {output!r}")
    return values


def _definition(space: DesignSpace) -> dict[str, Any]:
    return {"num_vars": len(space.names), "names": list(space.names), "bounds": [[0.0, 1.0]] * len(space.names)}


def _salib(module: str) -> Any:
    try:
        return importlib.import_module(f"SALib.{module}")
    except ImportError as error:
        raise ExecutionError("sensitivity needs SALib: pip install 'codesign[analysis]'") from error
