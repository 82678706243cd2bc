"""What a builder must know of a flight that meets every demand: what was not checked, which limits it meets."""

from __future__ import annotations

from typing import Any

from codesign.problem.evaluation import Evaluation

OFTEN = 0.01  # share of the time at a limit from which on it is said
UNCHECKED = "Whether bodies collide was not checked: the study has no section [interference]."
ENDS = (("thrust_at_most", "largest", max), ("thrust_at_least", "smallest", min))


def watch(evaluation: Evaluation) -> list[str]:
    """Sentences on a design that flew; none on parts alone."""
    if not evaluation.flight:
        return []
    unchecked = [] if evaluation.flight.get("interference") else [UNCHECKED]
    return unchecked + _at_limits(evaluation.flight)


def _at_limits(flight: dict[str, Any]) -> list[str]:
    """The ends of the thrust that are met for more than a hundredth of the time, with share and extreme."""
    shares, found = flight.get("saturation", {}), []
    for key, end, extreme in ENDS:
        share = shares.get(key, 0.0)
        if share <= OFTEN:
            continue
        reached = flight.get("max_thrust" if extreme is max else "min_thrust")
        told = f" (it reached {reached:.3g}\u202fN)" if reached is not None else ""
        found.append(
            f"For {100 * share:.2g}\u202f% of the flight a thrust is within 1\u202f% of its range of the {end} that is "
            f"allowed{told}: there is no reserve for more."
        )
    return found
