"""Robust optimization: a study whose objectives are the mean or the worst over several tasks."""

from __future__ import annotations

import statistics
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from codesign.followup.derived import DerivedStudy, load_changes
from codesign.problem.design_space import DesignValue
from codesign.problem.evaluation import Evaluation
from codesign.problem.protocols import PartCache, Problem
from codesign.storage.cache import MemoryCache

Statistic = Literal["mean", "worst", "both"]
STATISTICS = ("mean", "worst", "both")


@dataclass(frozen=True)
class RobustStudy(DerivedStudy):
    """A study flown on several trajectories.

    A design is feasible if it is on all trajectories; a violation is the worst of them. Objectives: the mean or the
    worst of the trajectories' values under their own names, or both as `name_mean` and `name_worst`. The time limit of
    an evaluation is for all trajectories together.
    """

    trajectories: tuple[str, ...]
    statistic: Statistic = "worst"
    loader: str = "codesign.followup.robust:load_robust"

    def __post_init__(self) -> None:
        if not self.trajectories:
            raise ValueError("a robust study needs at least one trajectory")
        if self.statistic not in STATISTICS:
            raise ValueError(f"statistic = {self.statistic!r}: one of {', '.join(STATISTICS)}")

    @property
    def changes(self) -> dict[str, Any]:
        """Trajectories and statistic."""
        return {"trajectories": self.trajectories, "statistic": self.statistic}

    @property
    def objectives(self) -> tuple[str, ...]:
        """The study's, or two for each of them."""
        if self.statistic != "both":
            return self.study.objectives
        return tuple(f"{name}_{statistic}" for name in self.study.objectives for statistic in ("mean", "worst"))

    def evaluate(
        self, design: Mapping[str, DesignValue], /, trajectory: str | None = None, cache: PartCache | None = None
    ) -> Evaluation:
        """One design on all trajectories (or on the one named); its parts are analyzed once."""
        cache = cache if cache is not None else MemoryCache()
        names = self.trajectories if trajectory is None else (trajectory,)
        results = [self.study.evaluate(design, trajectory=name, cache=cache) for name in names]
        return aggregate(dict(zip(names, results, strict=True)), self.statistic)


def load_robust(source: str) -> RobustStudy:
    """Inverse of `RobustStudy.source`."""
    study, changes = load_changes(source)
    return RobustStudy(study, tuple(changes["trajectories"]), changes["statistic"])


def robust(
    study: Problem, trajectories: Sequence[str], seeds: Sequence[int] = (), statistic: Statistic = "worst"
) -> RobustStudy:
    """A robust study over `trajectories`, each flown with every one of the disturbance `seeds` if there are any."""
    tasks = [f"{name}@{seed}" for name in trajectories for seed in seeds] if seeds else list(trajectories)
    return RobustStudy(study, tuple(tasks), statistic)


def aggregate(results: Mapping[str, Evaluation], statistic: Statistic) -> Evaluation:
    """One evaluation of several of the same design, by task."""
    first = next(iter(results.values()))
    failed = {name: result for name, result in results.items() if result.status == "failed"}
    if failed:
        name, result = next(iter(failed.items()))
        return Evaluation.failure(first.design, f"{name}: {result.reason}", result.provenance)
    infeasible = any(result.status == "infeasible" for result in results.values())
    reasons = [f"{name}: {result.reason}" for name, result in results.items() if result.reason]
    families = list(dict.fromkeys(family for result in results.values() for family in result.objective_families))
    return Evaluation(
        design=first.design,
        status="infeasible" if infeasible else "feasible",
        reason="; ".join(reasons) or None,
        objectives=_combine([result.objectives for result in results.values()], statistic),
        objective_families={
            family: _combine([result.objective_families.get(family, {}) for result in results.values()], statistic)
            for family in families
        },
        constraints=_constraints(results),
        violations=_worst([result.violations for result in results.values()]),
        margins=_least([result.margins for result in results.values()]),
        parts=first.parts,
        flight={
            "trajectory": ", ".join(results),
            "objectives": {name: result.objectives for name, result in results.items()},
            "flights": {name: result.flight for name, result in results.items()},
        },
        seconds=_sum([result.seconds for result in results.values()]),
        provenance=first.provenance,
    )


def _combine(values: Sequence[Mapping[str, float]], statistic: Statistic) -> dict[str, float]:
    """Statistics of the objectives that all tasks have."""
    common = [name for name in values[0] if all(name in other for other in values)]
    combined: dict[str, float] = {}
    for name in common:
        numbers = [other[name] for other in values]
        if statistic in ("mean", "both"):
            combined[f"{name}_mean" if statistic == "both" else name] = statistics.fmean(numbers)
        if statistic in ("worst", "both"):
            combined[f"{name}_worst" if statistic == "both" else name] = max(numbers)
    return combined


def _constraints(results: Mapping[str, Evaluation]) -> dict[str, float]:
    """A constraint's value by name if all tasks agree on it, else by `name@task`."""
    constraints: dict[str, Any] = {}
    for name in dict.fromkeys(name for result in results.values() for name in result.constraints):
        values = {task: result.constraints[name] for task, result in results.items() if name in result.constraints}
        if len(set(values.values())) == 1:
            constraints[name] = next(iter(values.values()))
        else:
            constraints |= {f"{name}@{task}": value for task, value in values.items()}
    return constraints


def _worst(values: Sequence[Mapping[str, float]]) -> dict[str, float]:
    names = dict.fromkeys(name for entry in values for name in entry)
    return {name: max(entry.get(name, 0.0) for entry in values) for name in names}


def _least(values: Sequence[Mapping[str, float]]) -> dict[str, float]:
    names = dict.fromkeys(name for entry in values for name in entry)
    return {name: min(entry[name] for entry in values if name in entry) for name in names}


def _sum(values: Sequence[Mapping[str, float]]) -> dict[str, float]:
    names = dict.fromkeys(name for entry in values for name in entry)
    return {name: sum(entry.get(name, 0.0) for entry in values) for name in names}
