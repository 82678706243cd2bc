"""What the figures are drawn from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from codesign.problem.evaluation import Evaluation
from codesign.report.data import ReportData
from codesign.report.details import Detail, detail_key


@dataclass(frozen=True)
class FigureData:
    """A run, its details by `detail_key`, its study (None if it cannot be loaded), its validation (None if none)."""

    run: ReportData
    details: Mapping[str, Detail] = field(default_factory=dict)
    study: Any = None
    validation: Any = None

    def detail(self, evaluation: Evaluation | None) -> Detail | None:
        """Details of an evaluated design, if there are any."""
        return None if evaluation is None else self.details.get(detail_key(evaluation))

    @property
    def recommended(self) -> Evaluation | None:
        """The design to build."""
        return None if self.run.recommended is None else self.run.entries[self.run.recommended].evaluation

    @property
    def compared(self) -> dict[str, Evaluation]:
        """The original and the recommended design, whichever there are, by name."""
        found = {"original": self.run.baseline, "recommended": self.recommended}
        return {name: evaluation for name, evaluation in found.items() if evaluation is not None}
