"""All CAD files of a design: what goes to the workshop and into a viewer."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from codesign.errors import LibraryError
from codesign.geometry.mesh_files import write_3mf, write_glb, write_stl
from codesign.parts.component import Component, distinct_parts
from codesign.parts.part import EXPORT_RESOLUTION


def export_parts(
    components: Sequence[Component],
    folder: str | os.PathLike[str],
    schema: str = "AP242",
    *,
    revision: str = "",
    organization: str = "",
) -> list[Path]:
    """Writes the files of placed parts into `folder` (made if absent); returns their paths.

    NAME.stl and NAME.step (mm) of every distinct part, parts.3mf (mm) with all components side
    by side, assembly.step (mm) and assembly.glb (m) with every component in its place.

    revision, organization: of the STEP files' products and headers.

    Raises: GeometryError if a part cannot be built; ValueError if two different parts share a name.
    """
    try:
        from codesign.parts.step import Origin, part_breps, write_step, write_step_assembly  # loaded when asked for
    except ImportError as error:
        raise LibraryError.of(error, "STEP") from error

    parts = {part.name: part for part in distinct_parts(components)}
    if len(parts) != len(distinct_parts(components)):
        raise ValueError("two different parts of the assembly have the same name")
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    solids = {name: part.solid(EXPORT_RESOLUTION) for name, part in parts.items()}
    breps, origin = part_breps(list(parts.values())), Origin(revision, organization)
    files = []
    for name, part in parts.items():
        files += [folder / f"{name}.stl", folder / f"{name}.step"]
        write_stl(solids[name], files[-2], part.title)
        write_step(part, files[-1], schema, breps[part], origin)
    files += [folder / "parts.3mf", folder / "assembly.glb", folder / "assembly.step"]
    write_3mf(solids, files[-3], Counter(component.part.name for component in components))
    write_glb(solids, [(c.name, c.part.name, c.pose) for c in components], files[-2])
    write_step_assembly(components, files[-1], schema=schema, breps=breps, origin=origin)
    return files
