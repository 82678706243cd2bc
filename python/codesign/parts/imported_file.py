"""STEP and BREP files as shapes of the part language."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

from codesign.errors import GeometryError
from codesign.geometry.exact import Exact, imported


def imported_file(
    path: str | os.PathLike[str],
    *,
    sha256: str,
    faces: Mapping[str, str | int] | None = None,
    solid: str | None = None,
) -> Exact:
    """One solid of a STEP or BREP file as a shape, in mm whatever the unit of a STEP file.

    Args:
        path: of the file, such as `Path(__file__).with_name("bracket.step")`.
        sha256: first 16 or more digits of the file's hash: so its content counts in the study's hash, as all must that
            decides a part. A wrong one is refused with the right one.
        faces: name -> name of the file's face, or its number from 1; by default the names in the file are kept.
        solid: name or number of the solid where a STEP file has several.
    Raises: GeometryError: no such file, another content, not one solid, no such face; MeshError as `fem.load_step`.
    """
    path = Path(path)
    try:
        found = hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError as error:
        raise GeometryError(f"{path}: cannot be read: {error.strerror}") from error
    if len(sha256) < 16 or not found.startswith(sha256.lower()):
        raise GeometryError(f"{path}: its content is not that of sha256={sha256!r}; it is {found[:16]!r} now")
    chosen = None if faces is None else tuple(faces.items())
    return _read(path, found, chosen, solid)


@lru_cache(maxsize=16)
def _read(path: Path, content: str, chosen: tuple[tuple[str, str | int], ...] | None, solid: str | None) -> Exact:
    """content: hash of the file, by which results are kept."""
    del content
    from OCP.TopAbs import TopAbs_ShapeEnum

    from codesign.geometry.brep import explore

    if path.suffix.lower() in (".brep", ".brp"):
        shape: Any = _brep(path)
        names: dict[int, str] = {}
    else:
        from codesign.fem.step import read_solid

        shape, names = read_solid(path, solid)
    own = explore(shape, TopAbs_ShapeEnum.TopAbs_FACE)
    if chosen is None:
        titles = dict.fromkeys(name for name in names.values() if name)
        return imported(shape, {name: [own[k] for k, other in names.items() if other == name] for name in titles})
    wanted: dict[str, list[Any]] = {}
    for name, face in chosen:
        numbers = [face - 1] if isinstance(face, int) else [k for k, other in names.items() if other == face]
        if not numbers or not 0 <= numbers[0] < len(own):
            there = ", ".join(dict.fromkeys(filter(None, names.values()))) or f"no names, {len(own)} faces"
            raise GeometryError(f"{path}: no face {face!r}; there are {there}")
        wanted[name] = [own[k] for k in numbers]
    return imported(shape, wanted)


def _brep(path: Path) -> Any:
    from OCP.BRep import BRep_Builder
    from OCP.BRepTools import BRepTools
    from OCP.TopoDS import TopoDS_Shape

    shape = TopoDS_Shape()
    if not BRepTools.Read_s(shape, str(path), BRep_Builder()) or shape.IsNull():
        raise GeometryError(f"{path}: is not a BREP file that OpenCASCADE can read")
    return shape
