"""What a run knows of its designs as they would be made: samples within the tolerances, kept beside the run."""

from __future__ import annotations

import json
import logging
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

logger = logging.getLogger(__name__)

FILE = "tolerances.json"
WANTED_SHARE = 0.99  # of the samples that must be feasible for a design to be recommended


@dataclass(frozen=True, slots=True)
class Spread:
    """Of a number over the samples that have it: smallest, 5 %, 50 % and 95 % quantile, largest."""

    least: float
    low: float
    median: float
    high: float
    most: float


@dataclass(frozen=True, slots=True)
class MadeDesign:
    """A design over its samples.

    feasible: how many of `samples` are. reasons: why the others are not, each once. numbers: objectives, and
    `parts.NAME.safety_factor` of every part.
    """

    role: str
    design: dict[str, Any]
    samples: int
    feasible: int
    reasons: tuple[str, ...] = ()
    numbers: dict[str, Spread] = field(default_factory=dict)

    @property
    def share(self) -> float:
        """Of the samples that are feasible."""
        return self.feasible / self.samples

    @property
    def robust(self) -> bool:
        """Whether enough samples are feasible to recommend it."""
        return self.share >= WANTED_SHARE


@dataclass(frozen=True, slots=True)
class Tolerances:
    """All sampled designs of a run. widths: the study's [tolerances] that were drawn from."""

    designs: tuple[MadeDesign, ...]
    widths: dict[str, Any]

    def of(self, design: dict[str, Any]) -> MadeDesign | None:
        """The samples of a design, if it has some."""
        return next((made for made in self.designs if made.design == design), None)

    def to_json(self) -> str:
        """JSON text; floats round-trip exactly."""
        return json.dumps({"widths": self.widths, "designs": [asdict(made) for made in self.designs]})

    @classmethod
    def from_json(cls, text: str) -> Tolerances:
        """Inverse of `to_json`."""
        document = json.loads(text)
        designs = tuple(
            MadeDesign(
                **made
                | {
                    "reasons": tuple(made["reasons"]),
                    "numbers": {name: Spread(**spread) for name, spread in made["numbers"].items()},
                }
            )
            for made in document["designs"]
        )
        return cls(designs, document["widths"])


def load_tolerances(directory: Path) -> Tolerances | None:
    """The samples kept with a run; None if there are none, or, with a warning, if they cannot be read."""
    path = directory / FILE
    if not path.exists():
        return None
    try:
        return Tolerances.from_json(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, TypeError, KeyError) as error:
        logger.warning("%s is left out, sample again: %s: %s", path, type(error).__name__, error)
        return None
