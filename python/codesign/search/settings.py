"""Settings of a run: everything that decides which designs it evaluates, kept in its store."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

from codesign.problem.design_space import DesignSpace
from codesign.search.base import Grid, Search
from codesign.search.plan import Plan, Schedule, Termination
from codesign.search.registry import find_search

PENDING = 4096  # designs that a search which learns nothing asks for ahead


@dataclass(frozen=True, slots=True)
class Settings:
    """Which designs a run evaluates, given what it is told; resume needs nothing else.

    algorithm: a name that `codesign.search.registry.find_search` knows; `listed` for the grid points in `listed`.
    options: the search's own settings.
    evaluations: the whole budget, start population included; None: until nothing is left to ask for.
    first: grid points at the head of the start population.
    lazy: strength and clearances of designs that cannot enter the front are not computed, where the problem can do so.
    steady: no barrier between generations; at most `lag` designs (default: population) are unranked at a time.
    """

    algorithm: str = "nsga2"
    population: int = 25
    evaluations: int | None = 1000
    crossover_probability: float = 0.9
    mutation_probability: float = 0.25
    seed: int = 1
    start: str = "sobol"
    first: tuple[Grid, ...] = ()
    steady: bool = False
    lag: int | None = None
    lazy: bool = False
    wall_time: float | None = None
    stall_generations: int | None = None
    stall_tolerance: float = 1e-3
    listed: tuple[Grid, ...] = ()
    options: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.population < 2:
            raise ValueError(f"population = {self.population}: at least 2 is needed")
        for name in ("evaluations", "lag", "wall_time", "stall_generations"):
            value = getattr(self, name)
            if value is not None and not 0 < value < math.inf:
                raise ValueError(f"{name} = {value}: must be above 0 and finite")
        for name in ("crossover_probability", "mutation_probability"):
            if not 0.0 <= getattr(self, name) <= 1.0:
                raise ValueError(f"{name} = {getattr(self, name)}: must be in 0 … 1")

    @classmethod
    def listing(cls, grids: Sequence[Grid]) -> Settings:
        """Of a run that evaluates the given grid points, each once."""
        return cls(algorithm="listed", listed=tuple(dict.fromkeys(grids)), evaluations=None)

    def document(self) -> dict[str, Any]:
        """As stored: JSON values only."""
        document: dict[str, Any] = json.loads(json.dumps(asdict(self)))
        return document

    @classmethod
    def from_document(cls, document: Mapping[str, Any]) -> Settings:
        """Inverse of `document`."""
        lists = {name: tuple(tuple(grid) for grid in document[name]) for name in ("first", "listed")}
        return cls(**(dict(document) | lists))

    def search(self, space: DesignSpace, objectives: Sequence[str]) -> Search:
        """The search that these settings describe. Raises: ValueError if they make no sense."""
        kind = find_search(self.algorithm)
        return kind.make(space, objectives, self, kind.checked_options(self.options))

    def plan(self, space: DesignSpace, objectives: Sequence[str]) -> Plan:
        """The search with when to ask and when to end. Raises: ValueError if the settings make no sense."""
        size, kind = self.population, find_search(self.algorithm)
        if not kind.learns:
            schedule = Schedule(size, size, max(PENDING, size))
        elif self.steady:
            schedule = Schedule(size, 1, self.lag or size)
        else:
            batch = kind.batch(kind.checked_options(self.options)) if kind.batch else None
            schedule = Schedule(size, batch, 2 * batch) if batch else Schedule(size)
        stop = Termination(self.evaluations, self.wall_time, self.stall_generations, self.stall_tolerance)
        total = min(self.evaluations or len(self.listed), math.prod(space.levels))
        return Plan(self.search(space, objectives), schedule, stop, total, self.lazy)
