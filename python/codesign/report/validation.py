"""What a validation holds: flights of chosen designs on other trajectories, compared case by case with the original."""

from __future__ import annotations

import json
import logging
import math
import statistics
from dataclasses import asdict, dataclass
from pathlib import Path

from codesign.problem.design_space import DesignValue

logger = logging.getLogger(__name__)

FILE = "validation.json"
LEAST_PAIRS = 3  # disturbed flights that tell how much chance decides
ORIGINAL = "original"


@dataclass(frozen=True, slots=True)
class Disturbance:
    """How far the plant strays from the controller's model: standard deviations, drawn anew for each seed.

    gust: force on the base per axis [N], first order with `gust_time` [s]; mass: of each body, relative; thrust: of
    each jet, relative.
    """

    gust: float = 1.0
    gust_time: float = 1.0
    mass: float = 0.002
    thrust: float = 0.0005


@dataclass(frozen=True, slots=True)
class Flight:
    """One validation flight. seed: None for a calm one. objectives: empty if the flight was lost."""

    role: str
    design: dict[str, DesignValue]
    trajectory: str
    seed: int | None
    completed: bool
    reason: str | None
    objectives: dict[str, float]
    figures: dict[str, float]

    @property
    def case(self) -> tuple[str, int | None]:
        """What was flown: flights of two designs are compared case by case."""
        return self.trajectory, self.seed


@dataclass(frozen=True, slots=True)
class Validation:
    """The flights of a validation, by design, trajectory and seed."""

    flights: tuple[Flight, ...]
    disturbance: Disturbance

    @property
    def roles(self) -> tuple[str, ...]:
        """Designs by role, the original first."""
        return tuple(dict.fromkeys(flight.role for flight in self.flights))

    @property
    def trajectories(self) -> tuple[str, ...]:
        """Trajectories in the order flown."""
        return tuple(dict.fromkeys(flight.trajectory for flight in self.flights))

    def of(self, role: str, disturbed: bool | None = None) -> list[Flight]:
        """Flights of a design: calm ones, disturbed ones, or all."""
        return [f for f in self.flights if f.role == role and disturbed in (None, f.seed is not None)]

    def change(self, role: str, objective: str, disturbed: bool | None = None) -> dict[tuple[str, int | None], float]:
        """Relative change of an objective from the original to a design, for each flight that both completed."""
        before = {f.case: f.objectives.get(objective) for f in self.of(ORIGINAL, disturbed)}
        changes = {}
        for flight in self.of(role, disturbed):
            old, new = before.get(flight.case), flight.objectives.get(objective)
            if old and new is not None:
                changes[flight.case] = (new - old) / abs(old)
        return changes

    def noise(self, role: str, objective: str) -> float | None:
        """What chance leaves open of the mean relative change from the original to a design: two standard errors.

        Over the disturbed flights that both completed, paired by seed and trajectory; None for fewer than three. A
        smaller change is a tie.
        """
        changes = list(self.change(role, objective, True).values())
        if len(changes) < LEAST_PAIRS:
            return None
        return 2.0 * statistics.stdev(changes) / math.sqrt(len(changes))

    def to_json(self) -> str:
        """JSON text; floats round-trip exactly."""
        return json.dumps({"disturbance": asdict(self.disturbance), "flights": [asdict(f) for f in self.flights]})

    @classmethod
    def from_json(cls, text: str) -> Validation:
        """Inverse of `to_json`."""
        document = json.loads(text)
        flights = tuple(Flight(**flight) for flight in document["flights"])
        return cls(flights, Disturbance(**document["disturbance"]))


def load_validation(directory: Path) -> Validation | None:
    """The validation kept with a run; None if there is none, or, with a warning, if it cannot be read."""
    path = directory / FILE
    if not path.exists():
        return None
    try:
        return Validation.from_json(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, TypeError, KeyError) as error:
        logger.warning("%s is left out, validate again: %s: %s", path, type(error).__name__, error)
        return None
