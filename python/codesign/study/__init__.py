"""A study as data: configuration, loading and checking. Computes nothing."""

from codesign.study.loading import load, shipped_studies
from codesign.study.scaffold import new_study
from codesign.study.study import StudyData

__all__ = ["StudyData", "load", "new_study", "shipped_studies"]
