"""What a study author subclasses: parametric parts, their surfaces, load cases and CAD files."""

from __future__ import annotations

import os

from codesign.errors import LibraryError
from codesign.geometry.exact import imported
from codesign.parts.imported_file import imported_file
from codesign.parts.part import MirroredPart, Part, parameter

__all__ = ["MirroredPart", "Part", "imported", "imported_file", "parameter", "write_step"]


def write_step(part: Part, path: str | os.PathLike[str], schema: str = "AP242") -> None:
    """The exact solid of a part with named faces as STEP in mm, application protocol "AP214" or "AP242".

    Raises: LibraryError: OpenCASCADE cannot be loaded; GeometryError.
    """
    try:
        from codesign.parts.step import write_step as write  # OpenCASCADE is loaded only when asked for
    except ImportError as error:
        raise LibraryError.of(error, "STEP") from error
    write(part, path, schema)
