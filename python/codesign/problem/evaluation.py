"""The result of one evaluation: what is ranked, stored, printed and reported."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, Literal

from codesign.problem.design_space import DesignValue

Status = Literal["feasible", "infeasible", "skipped", "failed"]


@dataclass(frozen=True, slots=True)
class Evaluation:
    """All numbers of one design; SI units except `design`, which keeps the study's units.

    status: `feasible`; `infeasible` (constraints violated, numbers valid); `skipped` (cannot enter the
        front, so its remaining constraints were not computed); `failed` (no numbers). `reason` says why.
    objectives: the family that the study minimizes; empty if the flight was lost (infeasible) or the evaluation failed.
    violations: how far each constraint is violated, relative to its limit; 0 where it holds. Ranking uses their sum.
    margins: the same with the other sign and, where a constraint holds, by how much; absent where it has no number.
    """

    design: dict[str, DesignValue]
    status: Status
    reason: str | None = None
    objectives: dict[str, float] = field(default_factory=dict)
    objective_families: dict[str, dict[str, float]] = field(default_factory=dict)
    constraints: dict[str, float] = field(default_factory=dict)
    violations: dict[str, float] = field(default_factory=dict)
    margins: dict[str, float] = field(default_factory=dict)
    parts: dict[str, dict[str, Any]] = field(default_factory=dict)
    flight: dict[str, Any] = field(default_factory=dict)
    seconds: dict[str, float] = field(default_factory=dict)
    provenance: dict[str, Any] = field(default_factory=dict)

    @classmethod
    def failure(
        cls, design: dict[str, DesignValue], reason: str, provenance: dict[str, Any] | None = None
    ) -> Evaluation:
        """A failed evaluation."""
        return cls(design=design, status="failed", reason=reason, provenance=provenance or {})

    @property
    def total_violation(self) -> float:
        """Sum of the constraint violations, relative to their limits; 0 for a feasible design."""
        return sum(self.violations.values())

    def to_dict(self) -> dict[str, Any]:
        """The JSON document of `codesign evaluate --json`."""
        return dataclasses.asdict(self)

    @classmethod
    def from_dict(cls, document: dict[str, Any]) -> Evaluation:
        """Inverse of `to_dict`."""
        return cls(**document)

    def to_json(self) -> str:
        """One line of JSON; floats round-trip exactly."""
        return json.dumps(self.to_dict(), allow_nan=False)

    @classmethod
    def from_json(cls, text: str) -> Evaluation:
        """Inverse of `to_json`."""
        return cls.from_dict(json.loads(text))


def least_infeasible(evaluations: Iterable[Evaluation]) -> Evaluation | None:
    """Of the infeasible designs the one that violates least, the first of several; None if there is none."""
    infeasible = [evaluation for evaluation in evaluations if evaluation.status == "infeasible"]
    return min(infeasible, key=lambda evaluation: evaluation.total_violation, default=None)
