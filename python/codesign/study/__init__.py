"""A study as data: configuration, loading and checking. Computes nothing."""

from codesign.study.loading import load_study, shipped_studies
from codesign.study.scaffold import new_study
from codesign.study.study import Study

__all__ = ["Study", "load_study", "new_study", "shipped_studies"]
