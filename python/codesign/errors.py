"""Typed errors: what went wrong, where and why. Every error of the product derives from CodesignError."""

from __future__ import annotations


class CodesignError(Exception):
    """Base of all errors that a user's input or a numerical breakdown can cause."""


class StudyError(CodesignError):
    """A study file that cannot be used; the message names file, key and reason."""


class DesignError(CodesignError, ValueError):
    """Design values that are unknown, missing, out of bounds or off the grid."""


class GeometryError(CodesignError):
    """A part whose parameters give no valid solid; the message names parameter, value and limit."""


class UrdfError(CodesignError):
    """A robot description that cannot be simulated; the message names the element."""


class UnknownNameError(UrdfError, ValueError):
    """A joint or frame that the robot does not have; the message lists what it has."""


class MeshError(CodesignError):
    """A surface or volume mesh that is open, inverted, degenerate, too large, or could not be made."""


class ModelError(CodesignError, ValueError):
    """Supports or loads that make no sense for a part; the message names what, why and the remedy."""


class MeshLimitError(MeshError):
    """A limit of the mesher (work, vertices, time) was reached; the message names the limit and the place."""


class SolverError(CodesignError):
    """A linear system that is singular or whose solution misses the residual tolerance."""


class MemoryLimitError(SolverError):
    """An analysis that needs more memory than it may take; the message names both and the remedy."""


class StoreError(CodesignError):
    """A run's database that cannot be opened, read or written."""


class ExecutionError(CodesignError):
    """Evaluations cannot be run at all: workers do not start, keep dying, or disagree with the study."""


class LibraryError(CodesignError):
    """A library that is missing or cannot be loaded; the message names it and the remedy."""

    @classmethod
    def of(cls, error: ImportError, use: str | None = None) -> LibraryError:
        """What a failed import means; use: what needs the library."""
        subject = f"{use} needs a library that cannot be loaded: " if use else ""
        return cls(f"{subject}{' '.join(str(error).split())}; `codesign doctor` shows what is missing")


class ExportError(CodesignError):
    """A folder that an export may not or cannot be written into."""


class FileError(CodesignError):
    """A file or folder that cannot be read or written; the message names it and the reason."""
