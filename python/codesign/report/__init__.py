"""Figures and pages made from a run's store; nothing here computes physics."""

from codesign.report.writing import ReportPaths, write_report

__all__ = ["ReportPaths", "write_report"]
