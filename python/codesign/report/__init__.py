"""Figures and pages made from a run's store; nothing here computes physics."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from codesign.report.writing import ReportPaths, write_report

__all__ = ["ReportPaths", "write_report"]


def __getattr__(name: str) -> Any:
    """What writes pages loads models and figures: imported when first used, since others need the words alone."""
    if name not in __all__:
        raise AttributeError(f"module 'codesign.report' has no attribute {name!r}")
    from codesign.report import writing

    return getattr(writing, name)
