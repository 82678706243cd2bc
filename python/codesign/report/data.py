"""What a report shows: a run's designs, its front, what was gained over the original, which design to build."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np

from codesign.problem.design_space import DesignSpace, Variable
from codesign.problem.evaluation import Evaluation
from codesign.problem.pareto import non_dominated
from codesign.problem.quantities import Quantity, words
from codesign.report.pareto import Mask, Matrix, dominates, hypervolume_history, knee

MOST = 0.93  # of the feasible designs are in view


@dataclass(frozen=True, slots=True)
class Entry:
    """One finished design; `id` is what people call it, `generation` the step of the search that asked for it."""

    id: int
    evaluation: Evaluation
    generation: int | None = None


@dataclass(frozen=True)
class ReportData:
    """A run as the report, the figures and the viewer read it.

    entries: finished designs in the order of evaluation. waiting: designs that were asked for and have no result yet.
    baseline: the design that everything is compared with, None if the study names none or it could not be evaluated.
    limits: constraint -> (sign, limit in SI units), sign ">=" or "<="; the others are only watched.
    provenance: what made the numbers, for people.
    labels: variable -> name for people.   notes: what a reader must know before trusting the numbers.
    """

    directory: Path
    title: str
    description: str
    variables: tuple[Variable, ...]
    objectives: tuple[Quantity, ...]
    entries: tuple[Entry, ...]
    baseline: Evaluation | None = None
    waiting: int = 0
    planned: int | None = None
    limits: dict[str, tuple[str, float]] = field(default_factory=dict)
    provenance: dict[str, str] = field(default_factory=dict)
    labels: dict[str, str] = field(default_factory=dict)
    export_command: str = "codesign export"
    notes: tuple[str, ...] = ()

    def label(self, variable: Variable) -> str:
        """A variable's name for people."""
        return words(self.labels.get(variable.name) or variable.name)

    @property
    def space(self) -> DesignSpace:
        """The design variables."""
        return DesignSpace(self.variables)

    @property
    def keys(self) -> tuple[str, ...]:
        """Objective keys in order."""
        return tuple(o.key for o in self.objectives)

    def vector(self, evaluation: Evaluation) -> Matrix:
        """Objectives (m,) of an evaluation; NaN where it has none."""
        return np.array([evaluation.objectives.get(key, np.nan) for key in self.keys])

    @cached_property
    def values(self) -> Matrix:
        """Objectives (n, m) of the entries; NaN where a design has none."""
        return np.array([self.vector(e.evaluation) for e in self.entries]).reshape(-1, len(self.objectives))

    @cached_property
    def feasible(self) -> Mask:
        """Mask (n,) of the feasible entries."""
        return np.array([e.evaluation.status == "feasible" for e in self.entries], dtype=bool)

    @cached_property
    def front(self) -> list[int]:
        """Positions of the best compromises, by the first objective: feasible, dominated by no feasible design."""
        feasible = np.flatnonzero(self.feasible)
        if not len(feasible):
            return []
        best = feasible[non_dominated(self.values[feasible])]
        return [int(i) for i in best[np.argsort(self.values[best, 0], kind="stable")]]

    @cached_property
    def baseline_vector(self) -> Matrix | None:
        """Objectives (m,) of the baseline, None if it has not all of them."""
        if self.baseline is None:
            return None
        vector = self.vector(self.baseline)
        return vector if np.isfinite(vector).all() else None

    @cached_property
    def recommended(self) -> int | None:
        """Position of the design to build: the knee of the front, if possible nowhere worse than the baseline."""
        if not self.front:
            return None
        return self.front[knee(self.values[self.front], self.baseline_vector)]

    @cached_property
    def best(self) -> dict[str, int]:
        """Objective -> position of the feasible design with its lowest value."""
        if not self.front:
            return {}
        return {key: self.front[int(np.argmin(self.values[self.front, k]))] for k, key in enumerate(self.keys)}

    @cached_property
    def dominating(self) -> list[int]:
        """Positions on the front that dominate the baseline."""
        vector = self.baseline_vector
        return [] if vector is None else [i for i in self.front if dominates(self.values[i], vector)]

    @cached_property
    def counts(self) -> Counter[str]:
        """Number of designs by status."""
        return Counter(e.evaluation.status for e in self.entries)

    @cached_property
    def hypervolume(self) -> Matrix:
        """Hypervolume (n,) of the feasible designs after each evaluation, in the box that all of them span."""
        return hypervolume_history(self.values, self.feasible)

    def view(self, k: int) -> tuple[float, float] | None:
        """Range of objective `k` that shows the front, the original and most feasible designs; outliers lie outside."""
        shown = [float(self.values[i, k]) for i in self.front]
        if self.baseline_vector is not None:
            shown.append(float(self.baseline_vector[k]))
        if self.feasible.any():
            shown += np.quantile(self.values[self.feasible, k], [0.0, MOST]).tolist()
        if not shown:
            return None
        low, high = min(shown), max(shown)
        margin = 0.07 * (high - low) or 0.05 * abs(high) or 1.0
        return low - margin, high + margin

    def gain(self, position: int) -> Matrix | None:
        """Relative change (m,) of each objective from the baseline to an entry: negative is better."""
        vector = self.baseline_vector
        if vector is None:
            return None
        difference = self.values[position] - vector
        with np.errstate(divide="ignore"):
            return np.asarray(np.divide(difference, np.abs(vector), out=0.0 * difference, where=difference != 0.0))

    def find(self, design: Evaluation) -> int | None:
        """Position of an evaluation's design among the entries."""
        for i, entry in enumerate(self.entries):
            if entry.evaluation.design == design.design:
                return i
        return None

    @cached_property
    def highlights(self) -> dict[str, Evaluation]:
        """Designs worth a closer look, each once: the recommended, the best of each objective, the original."""
        chosen: dict[str, Evaluation] = {}
        if self.recommended is not None:
            chosen["recommended"] = self.entries[self.recommended].evaluation
        for objective in self.objectives:
            if objective.key in self.best:
                chosen.setdefault(
                    f"lowest {objective.label.lower()}", self.entries[self.best[objective.key]].evaluation
                )
        if self.baseline is not None:
            chosen["original"] = self.baseline
        unique: dict[str, Evaluation] = {}
        for role, evaluation in chosen.items():
            if all(evaluation.design != other.design for other in unique.values()):
                unique[role] = evaluation
        return unique


def reasons(run: ReportData) -> list[tuple[str, str, list[int]]]:
    """Why designs were not feasible: (status, reason without its numbers, ids), the most frequent first."""
    groups: dict[tuple[str, str], list[int]] = {}
    for entry in run.entries:
        evaluation = entry.evaluation
        if evaluation.status != "feasible":
            groups.setdefault((evaluation.status, pattern(evaluation)), []).append(entry.id)
    return sorted(((s, r, ids) for (s, r), ids in groups.items()), key=lambda g: (g[0] != "failed", -len(g[2])))


def pattern(evaluation: Evaluation) -> str:
    """The reason with numbers replaced by `…`, so that designs that fail alike count together."""
    import re

    text = evaluation.reason or ", ".join(k for k, v in evaluation.violations.items() if v > 0) or "no reason recorded"
    return re.sub(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?", "…", text)
