"""All CAD files of a design: what goes to the workshop and into a viewer."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from codesign.errors import LibraryError
from codesign.geometry.mesh_files import write_3mf, write_glb, write_stl
from codesign.parts.component import Component, distinct_parts
from codesign.parts.part import EXPORT_RESOLUTION, Part

if TYPE_CHECKING:
    from codesign.geometry.brep import Brep
    from codesign.parts.drawing import Caption

FORMATS = ("stl", "step", "3mf", "glb")
EXACT = ("step", "pdf", "dxf")  # those that need the B-rep


def export_parts(
    components: Sequence[Component],
    folder: str | os.PathLike[str],
    schema: str = "AP242",
    *,
    revision: str = "",
    organization: str = "",
    formats: Collection[str] = FORMATS,
    captions: Mapping[str, Caption] | None = None,
) -> list[Path]:
    """Writes the files of placed parts into `folder` (made if absent); returns their paths.

    NAME.stl and NAME.step (mm) of every distinct part, parts.3mf (mm) with all components side
    by side, assembly.step (mm) and assembly.glb (m) with every component in its place.

    revision, organization: of the STEP files' products and headers. formats: which of stl, step, 3mf, glb, and of pdf,
    dxf: the drawing of every part, whose caption `captions` must have.

    Raises: GeometryError if a part cannot be built; ValueError if two different parts share a name.
    """
    parts = {part.name: part for part in distinct_parts(components)}
    if len(parts) != len(distinct_parts(components)):
        raise ValueError("two different parts of the assembly have the same name")
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    files = _write_meshes(components, parts, folder, formats)
    if not any(kind in formats for kind in EXACT):
        return files
    try:
        from codesign.parts.step import part_breps  # loaded when asked for
    except ImportError as error:
        raise LibraryError.of(error, "STEP") from error
    breps = part_breps(list(parts.values()))
    if "step" in formats:
        files += _write_steps(components, parts, breps, folder, schema, revision, organization)
    if captions is not None:
        files += _write_drawings(parts, breps, captions, folder, formats)
    return files


def _write_meshes(
    components: Sequence[Component], parts: Mapping[str, Part], folder: Path, formats: Collection[str]
) -> list[Path]:
    if set(formats) <= set(EXACT):
        return []
    solids = {name: part.solid(EXPORT_RESOLUTION) for name, part in parts.items()}
    files = []
    if "stl" in formats:
        for name, part in parts.items():
            files.append(folder / f"{name}.stl")
            write_stl(solids[name], files[-1], part.title)
    if "3mf" in formats:
        files.append(folder / "parts.3mf")
        write_3mf(solids, files[-1], Counter(component.part.name for component in components))
    if "glb" in formats:
        files.append(folder / "assembly.glb")
        write_glb(solids, [(c.name, c.part.name, c.pose) for c in components], files[-1])
    return files


def _write_steps(
    components: Sequence[Component],
    parts: Mapping[str, Part],
    breps: Mapping[Part, Brep],
    folder: Path,
    schema: str,
    revision: str,
    organization: str,
) -> list[Path]:
    from codesign.parts.step import Origin, write_step, write_step_assembly

    origin = Origin(revision, organization)
    files = [folder / f"{name}.step" for name in parts]
    for part, file in zip(parts.values(), files, strict=True):
        write_step(part, file, schema, breps[part], origin)
    write_step_assembly(components, folder / "assembly.step", schema=schema, breps=breps, origin=origin)
    return [*files, folder / "assembly.step"]


def _write_drawings(
    parts: Mapping[str, Part],
    breps: Mapping[Part, Brep],
    captions: Mapping[str, Caption],
    folder: Path,
    formats: Collection[str],
) -> list[Path]:
    from codesign.parts.drawing import draw_part
    from codesign.parts.sheet import write_dxf, write_pdf

    files = []
    writers = [(kind, write) for kind, write in (("pdf", write_pdf), ("dxf", write_dxf)) if kind in formats]
    for name, part in parts.items() if writers else ():
        sheet = draw_part(breps[part], captions[name])
        for kind, write in writers:
            files.append(folder / f"{name}.{kind}")
            write(sheet, files[-1])
    return files
