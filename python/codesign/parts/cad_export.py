"""All CAD files of a design: what goes to the workshop and into a viewer."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path

from codesign.errors import LibraryError
from codesign.geometry.mesh_files import write_3mf, write_glb, write_stl
from codesign.parts.component import Component, distinct_parts
from codesign.parts.part import EXPORT_RESOLUTION, Part

FORMATS = ("stl", "step", "3mf", "glb")


def export_parts(
    components: Sequence[Component],
    folder: str | os.PathLike[str],
    schema: str = "AP242",
    *,
    revision: str = "",
    organization: str = "",
    formats: Collection[str] = FORMATS,
) -> list[Path]:
    """Writes the files of placed parts into `folder` (made if absent); returns their paths.

    NAME.stl and NAME.step (mm) of every distinct part, parts.3mf (mm) with all components side
    by side, assembly.step (mm) and assembly.glb (m) with every component in its place.

    revision, organization: of the STEP files' products and headers. formats: which of stl, step, 3mf, glb.

    Raises: GeometryError if a part cannot be built; ValueError if two different parts share a name.
    """
    parts = {part.name: part for part in distinct_parts(components)}
    if len(parts) != len(distinct_parts(components)):
        raise ValueError("two different parts of the assembly have the same name")
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    files = _write_meshes(components, parts, folder, formats)
    return files + (
        _write_steps(components, parts, folder, schema, revision, organization) if "step" in formats else []
    )


def _write_meshes(
    components: Sequence[Component], parts: Mapping[str, Part], folder: Path, formats: Collection[str]
) -> list[Path]:
    if set(formats) <= {"step"}:
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
    folder: Path,
    schema: str,
    revision: str,
    organization: str,
) -> list[Path]:
    try:
        from codesign.parts.step import Origin, part_breps, write_step, write_step_assembly  # loaded when asked for
    except ImportError as error:
        raise LibraryError.of(error, "STEP") from error
    breps, origin = part_breps(list(parts.values())), Origin(revision, organization)
    files = [folder / f"{name}.step" for name in parts]
    for part, file in zip(parts.values(), files, strict=True):
        write_step(part, file, schema, breps[part], origin)
    write_step_assembly(components, folder / "assembly.step", schema=schema, breps=breps, origin=origin)
    return [*files, folder / "assembly.step"]
