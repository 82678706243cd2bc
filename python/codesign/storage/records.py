"""What a run's file holds: the rows of its designs and the states of its search."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from codesign.problem.evaluation import Evaluation

Grid = tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Record:
    """A finished row."""

    number: int | None
    generation: int | None
    grid: Grid
    trajectory: str
    evaluation: Evaluation
    cached: bool = False
    worker: str = ""
    wall_seconds: float = 0.0

    def identity(self) -> dict[str, Any]:
        """What must be equal in two runs of the same study: everything but times, places and versions."""
        document = _without_seconds(self.evaluation.to_dict())
        del document["provenance"]
        return {"number": self.number, "grid": self.grid, "trajectory": self.trajectory, **document}


@dataclass(frozen=True, slots=True)
class Generation:
    """State after a generation's results were told to the search."""

    generation: int
    told: int
    feasible: int
    infeasible: int
    failed: int
    hypervolume: float | None
    population: tuple[int, ...]


def _without_seconds(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _without_seconds(entry) for key, entry in value.items() if key != "seconds"}
    return value
