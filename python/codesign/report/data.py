"""What a report shows: a run's designs, its front, what was gained over the original, which design to build."""

from __future__ import annotations

import re
import shlex
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from codesign.chain.confirmed import with_confirmed
from codesign.problem.design_space import DesignSpace, DesignValue, Variable
from codesign.problem.evaluation import Evaluation, least_infeasible
from codesign.problem.pareto import non_dominated
from codesign.problem.quantities import Quantity, words
from codesign.report.comparison import ComparedRun
from codesign.report.objections import Objection, objections
from codesign.report.pareto import Mask, Matrix, dominates, hypervolume_history, knee_distances, late_growth
from codesign.report.tolerances import Tolerances

NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
MOST = 0.75  # of the feasible designs are in view, where the front is one design


@dataclass(frozen=True, slots=True)
class Entry:
    """One finished design; `id` is what people call it, `generation` the step of the search that asked for it."""

    id: int
    evaluation: Evaluation
    generation: int | None = None


@dataclass(frozen=True, slots=True)
class PartWords:
    """How a part is loaded and held, of what it is made.

    load: all of it. warning: why its mass and stress do not belong together. cases: load case -> its loads. held: its
    supports. carried: the rigid bodies on its faces, "" if there are none.
    """

    load: str
    material: str
    warning: str = ""
    cases: dict[str, str] = field(default_factory=dict)
    held: str = ""
    carried: str = ""


@dataclass(frozen=True, slots=True)
class DesignWords:
    """The study with a design's values in it. parts: part -> its load case and material. flight: what one flight is."""

    parts: Mapping[str, PartWords] = field(default_factory=dict)
    flight: str = ""


Limits = Mapping[str, tuple[str, float]]


@dataclass(frozen=True)
class ReportData:
    """A run as the report, the figures and the viewer read it.

    planned: evaluations of the budget, None once they are made. stopped: why the search ended before that, if it did.
    entries: finished designs in the order of evaluation. waiting: designs that were asked for and have no result yet.
    baseline: the design that everything is compared with, None if the study names none or it could not be evaluated.
    limits: constraint -> (sign, limit in SI units), sign ">=" or "<="; the others are only watched.
    provenance: what made the numbers, for people.
    export_original: what exports a design by its values.
    labels: variable -> name for people.   notes: what a reader must know before trusting the numbers.
    baseline_missing: why there is no baseline.
    tolerances: chosen designs as they would be made, if they were sampled.
    describe: design -> how its parts are loaded and made, how it flies: variables may set any number of the study.
    limits_of: design -> `limits` of that design, None where no variable sets one.
    stress_tolerance: relative error of stresses that is asked for.
    confirmed: values of a design -> its parts on finer meshes, or why there are none.
    compared: other runs whose fronts are shown beside this one's.
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
    stopped: str | None = None
    limits: dict[str, tuple[str, float]] = field(default_factory=dict)
    provenance: dict[str, str] = field(default_factory=dict)
    labels: dict[str, str] = field(default_factory=dict)
    export_original: str = "codesign export"
    notes: tuple[str, ...] = ()
    baseline_missing: str = "The study names no original design to compare with."
    describe: Callable[[Mapping[str, DesignValue]], DesignWords] = lambda _: DesignWords()
    limits_of: Callable[[Mapping[str, DesignValue]], Limits] | None = None
    tolerances: Tolerances | None = None
    stress_tolerance: float | None = None
    confirmed: dict[tuple[DesignValue, ...], Evaluation] = field(default_factory=dict)
    compared: tuple[ComparedRun, ...] = ()

    def label(self, variable: Variable) -> str:
        """A variable's name for people."""
        return words(self.labels.get(variable.name) or variable.name)

    @property
    def export_command(self) -> str:
        """What exports an entry of the run, but for its number and the folder."""
        return f"codesign export --run {shlex.quote(str(self.directory))}"

    @property
    def space(self) -> DesignSpace:
        """The design variables."""
        return DesignSpace(self.variables)

    @property
    def keys(self) -> tuple[str, ...]:
        """Objective keys in order."""
        return tuple(o.key for o in self.objectives)

    def vector(self, evaluation: Evaluation) -> Matrix:
        """Objectives (m,) of an evaluation, of which less is better, in the units shown; NaN where unknown."""
        return self.signs * self.shown(evaluation)

    def shown(self, evaluation: Evaluation) -> Matrix:
        """Objectives (m,) of an evaluation as people read them; NaN where unknown."""
        return np.array([o.shown(evaluation.objectives.get(o.key, np.nan)) for o in self.objectives])

    @cached_property
    def signs(self) -> Matrix:
        """(m,) from `vector` and `values` to the objectives as people read them, and back: -1 for a maximized one."""
        return np.array([o.sign for o in self.objectives])

    @cached_property
    def values(self) -> Matrix:
        """Objectives (n, m) of the entries, in the units of `objectives`; NaN where a design has none."""
        return np.array([self.vector(e.evaluation) for e in self.entries]).reshape(-1, len(self.objectives))

    @cached_property
    def statuses(self) -> NDArray[np.str_]:
        """Status (n,) of the entries."""
        return np.array([e.evaluation.status for e in self.entries], dtype=np.str_)

    @cached_property
    def feasible(self) -> Mask:
        """Mask (n,) of the feasible entries."""
        return np.asarray(self.statuses == "feasible")

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
        """Objectives (m,) of the baseline in the units of `objectives`, None if it has not all of them."""
        if self.baseline is None:
            return None
        vector = self.vector(self.baseline)
        return vector if np.isfinite(vector).all() else None

    def objections(self, position: int) -> tuple[Objection, ...]:
        """What speaks against building an entry."""
        return self.against(self.entries[position].evaluation)

    def against(self, evaluation: Evaluation) -> tuple[Objection, ...]:
        """What speaks against building a design of this study; its strength is judged as confirmed, if it is."""
        made = self.tolerances.of(evaluation.design) if self.tolerances is not None else None
        limits = self.demanded(evaluation)
        return objections(self.as_confirmed(evaluation), limits, made, self.stress_tolerance)

    def demanded(self, evaluation: Evaluation) -> Limits:
        """What the study demands of a design: constraint -> (sign, limit in SI units)."""
        return self.limits if self.limits_of is None else self.limits_of(evaluation.design)

    @property
    def subject(self) -> Evaluation | None:
        """The design that sentences about the run as a whole are about: the recommended one, else the original."""
        return self.baseline if self.recommended is None else self.entries[self.recommended].evaluation

    @property
    def flies(self) -> bool:
        """Whether designs are flown: a study may judge parts alone."""
        return any(entry.evaluation.flight for entry in self.entries)

    @property
    def subject_words(self) -> DesignWords:
        """The study with the values of `subject`."""
        return DesignWords() if self.subject is None else self.describe(self.subject.design)

    def as_confirmed(self, evaluation: Evaluation) -> Evaluation:
        """An evaluation with its parts as confirmed, where the run knows that."""
        found = self.confirmed.get(tuple(evaluation.design.values()))
        return with_confirmed(evaluation, found.parts) if found is not None and found.parts else evaluation

    @cached_property
    def choices(self) -> list[int]:
        """Positions of the best compromises among the designs that may be built, by the first objective.

        A design with a final objection never is among them; one with another only if there is none without any.
        """
        against = {int(i): self.objections(int(i)) for i in np.flatnonzero(self.feasible)}
        free = [i for i, found in against.items() if not found]
        free = free or [i for i, found in against.items() if not any(objection.final for objection in found)]
        if not free:
            return []
        best = np.array(free)[non_dominated(self.values[free])]
        return [int(i) for i in best[np.argsort(self.values[best, 0], kind="stable")]]

    @cached_property
    def ranking(self) -> list[tuple[int, float]]:
        """The choices with their distance from the best value of every objective at once, the nearest first.

        Where some are nowhere worse than the baseline, only these.
        """
        if not self.choices:
            return []
        distance = knee_distances(self.values[self.choices], self.baseline_vector)
        order = np.argsort(distance, kind="stable")
        return [(self.choices[i], float(distance[i])) for i in order if np.isfinite(distance[i])]

    @cached_property
    def recommended(self) -> int | None:
        """Position of the design to build, None if nothing should be: the knee of the choices."""
        return self.ranking[0][0] if self.ranking else None

    @cached_property
    def least_infeasible(self) -> int | None:
        """Position of the infeasible design that violates least, where no design is feasible."""
        if self.feasible.any():
            return None
        closest = least_infeasible(e.evaluation for e in self.entries)
        return None if closest is None else self.find(closest)

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

    @cached_property
    def late_growth(self) -> tuple[float, int]:
        """What the last quarter of the search added: share of the front's hypervolume, number of its designs."""
        return late_growth(self.values, self.feasible, self.front)

    def view(self, k: int) -> tuple[float, float] | None:
        """Range of objective `k`, as people read it: fronts, original, and as much again; outliers lie outside."""
        shown = [float(self.values[i, k]) for i in {*self.front, *self.choices}]
        shown += [float(value) for other in self.compared for value in other.values[:, k]]
        if self.baseline_vector is not None:
            shown.append(float(self.baseline_vector[k]))
        feasible = self.values[self.feasible, k]
        if not len(feasible):
            return None
        wide = max(shown) - min(shown) or float(np.subtract(*np.quantile(feasible, [MOST, 0.0])))
        near = feasible[(feasible >= min(shown) - wide) & (feasible <= max(shown) + wide)].tolist()
        low, high = min(shown + near), max(shown + near)
        margin = 0.07 * (high - low) or 0.05 * abs(high) or 1.0
        ends = self.signs[k] * np.array([low - margin, high + margin])
        return float(ends.min()), float(ends.max())

    def gain(self, position: int) -> Matrix | None:
        """Relative change (m,) of each objective from the baseline to an entry, negative is better; NaN from zero."""
        vector = self.baseline_vector
        if vector is None:
            return None
        difference = self.values[position] - vector
        size = np.where(vector != 0.0, np.abs(vector), np.nan)
        return np.asarray(np.where(difference != 0.0, difference / size, 0.0))

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
                    f"{'highest' if objective.maximized else 'lowest'} {objective.label.lower()}",
                    self.entries[self.best[objective.key]].evaluation,
                )
        if self.baseline is not None:
            chosen["original"] = self.baseline
        unique: dict[str, Evaluation] = {}
        for role, evaluation in chosen.items():
            if all(evaluation.design != other.design for other in unique.values()):
                unique[role] = evaluation
        return unique


def reasons(run: ReportData) -> list[tuple[str, str, list[int]]]:
    """Why designs were not feasible: (status, reason with the range of its numbers, ids), the most frequent first."""
    groups: dict[tuple[str, tuple[str, ...]], list[Entry]] = {}
    for entry in run.entries:
        if entry.evaluation.status != "feasible":
            key = (entry.evaluation.status, tuple(NUMBER.split(_reason(entry.evaluation))))
            groups.setdefault(key, []).append(entry)
    found = [(status, _with_ranges(words, same), [e.id for e in same]) for (status, words), same in groups.items()]
    return sorted(found, key=lambda group: (group[0] != "failed", -len(group[2])))


def _reason(evaluation: Evaluation) -> str:
    violated = ", ".join(key for key, violation in evaluation.violations.items() if violation > 0)
    return evaluation.reason or violated or "no reason recorded"


def _with_ranges(between: tuple[str, ...], alike: list[Entry]) -> str:
    """The reason that designs share, with each of its numbers as the range that it takes: `lost at 1.6 to 3.4 s`."""
    numbers = zip(*(NUMBER.findall(_reason(entry.evaluation)) for entry in alike), strict=True)
    text = between[0]
    for values, following in zip(numbers, between[1:], strict=True):
        least, most = min(values, key=float), max(values, key=float)
        text += (least if float(least) == float(most) else f"{least} to {most}") + following
    return text
