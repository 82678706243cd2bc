"""Values of design variables that a part refuses: its own limits, asked before a search wastes evaluations on them."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from codesign.problem.design_space import Design, Variable, value_text
from codesign.study.config import PartConfig
from codesign.study.parts import make_part
from codesign.study.study import StudyData

MOST_TRIALS = 2000  # combinations of values of a part that are all tried
OTHERS = 8  # combinations of the others' values that each value is tried with where there are more

Grid = tuple[int, ...]


class Refusal(NamedTuple):
    """Values that give no part. every: none of those tried gives one."""

    key: str
    reason: str
    every: bool


def refused_values(study: StudyData, typical: Design) -> Iterator[Refusal]:
    """Values and combinations of values that parts refuse when they are constructed; no shape is built.

    typical: of the variables that a part does not take.
    """
    for part in study.config.parts:
        trials = _trials(study, part, typical)
        if trials is not None and trials.refused:
            yield from _refusals(part, trials)


@dataclass(frozen=True)
class _Trials:
    """variables: that a part takes. tried: their grid indices. refused: those of them that give no part, and why."""

    variables: Sequence[Variable]
    tried: Sequence[Grid]
    refused: dict[Grid, str]

    @property
    def complete(self) -> bool:
        return len(self.tried) == math.prod(variable.levels for variable in self.variables)


def _trials(study: StudyData, part: PartConfig, typical: Design) -> _Trials | None:
    config = study.config
    read = {name.partition(".")[0] for name in part.parameters.values()}
    options = tuple(f"parts.{entry}.options." for entry in (part.name, config.parts.index(part)))
    setting = {
        name
        for name, variable in config.variables.items()
        if any(place.startswith(options) for place in (*variable.sets, *variable.chosen_keys))
    }
    variables = [variable for variable in study.space.variables if variable.name in read | setting]
    if not variables:
        return None
    tried, refused = _chosen([variable.levels for variable in variables]), {}
    for grid in tried:
        design = {**typical, **{v.name: v.value(i) for v, i in zip(variables, grid, strict=True)}}
        try:
            made = study.configured(design) if setting else config
            make_part(_of(made.parts, part.name), made, study.part_classes[part.name], design)
        except (Exception, SystemExit) as error:  # whatever a user's class raises
            refused[grid] = str(error) or type(error).__name__
    return _Trials(variables, tried, refused)


def _of(parts: Sequence[PartConfig], name: str) -> PartConfig:
    return next(part for part in parts if part.name == name)


def _chosen(levels: Sequence[int]) -> list[Grid]:
    """All combinations, or every value of each variable with some of the others', and all corners."""
    if math.prod(levels) <= MOST_TRIALS:
        return list(itertools.product(*map(range, levels)))
    random = np.random.default_rng(0)
    chosen = dict.fromkeys(itertools.product(*((0, n - 1) for n in levels)))
    for which, n in enumerate(levels):
        for index in range(n):
            for others in random.integers(0, levels, size=(OTHERS, len(levels))).tolist():
                others[which] = index
                chosen[tuple(others)] = None
    return list(chosen)


def _refusals(part: PartConfig, trials: _Trials) -> Iterator[Refusal]:
    key = f"parts.{part.name}"
    names = ", ".join(variable.name for variable in trials.variables)
    if len(trials.refused) == len(trials.tried):
        tried = "" if trials.complete else " that was tried"
        reason = next(iter(trials.refused.values()))
        yield Refusal(key, f"no combination of {names}{tried} gives a part; the first: {reason}", True)
        return
    dead = [_dead(trials, which) for which in range(len(trials.variables))]
    for which, variable in enumerate(trials.variables):
        for run in _runs(dead[which]):
            reason = next(text for grid, text in trials.refused.items() if grid[which] == run[0])
            verb = "gives" if len(run) == 1 else "give"
            told = f"{_run_text(variable, run)} {verb} no {part.name}, whatever the other values are: {reason}"
            yield Refusal(f"variables.{variable.name}", told, False)
    open_ = [grid for grid in trials.tried if all(i not in gone for i, gone in zip(grid, dead, strict=True))]
    left = [grid for grid in open_ if grid in trials.refused]
    if left:
        values = ", ".join(
            f"{v.name} = {value_text(v.value(i))}" for v, i in zip(trials.variables, left[0], strict=True)
        )
        tried = "" if trials.complete else " that were tried"
        told = f"{len(left)} of {len(open_)} combinations of {names}{tried} give no part, the first {values}"
        yield Refusal(key, f"{told}: {trials.refused[left[0]]}", False)


def _dead(trials: _Trials, which: int) -> list[int]:
    """Values of a variable that no tried combination gives a part with."""
    alive = {grid[which] for grid in trials.tried if grid not in trials.refused}
    return [index for index in range(trials.variables[which].levels) if index not in alive]


def _runs(indices: Sequence[int]) -> Iterator[list[int]]:
    """Neighboring indices together."""
    for _, run in itertools.groupby(enumerate(indices), key=lambda pair: pair[1] - pair[0]):
        yield [index for _, index in run]


def _run_text(variable: Variable, run: Sequence[int]) -> str:
    first, last = (value_text(variable.value(index)) for index in (run[0], run[-1]))
    unit = f" {variable.unit}" if variable.unit else ""
    many = f"{first} … {last}{unit} ({len(run)} of {variable.levels} values)"
    return f"{first}{unit}" if len(run) == 1 else many
