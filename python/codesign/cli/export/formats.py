"""Formats of an export: what is written, which units it is in, which library it needs."""

from __future__ import annotations

import importlib.util
from collections.abc import Collection
from typing import Literal

from codesign.errors import ExportError, LibraryError
from codesign.names import nearest

CAD = ("stl", "step", "3mf", "glb", "pdf", "dxf")
ROBOT = ("urdf", "mjcf", "sdf", "ros2")
LOG = ("csv", "parquet", "mcap")
FORMATS = (*CAD, *ROBOT, *LOG, "vtu", "msh")
DEFAULT = ("stl", "step", "3mf", "glb", "pdf", "urdf", "vtu")
SHORT = {"log": ("csv", "parquet"), "all": FORMATS}
Frames = Literal["keep", "drop", "tiny"]  # links without mass in robot files
FRAMES: tuple[Frames, ...] = ("keep", "drop", "tiny")
LIBRARIES = {
    "dxf": ("ezdxf", "drawing"),
    "parquet": ("pyarrow", "analysis"),
    "mcap": ("rosbags", "log"),
}  # format -> module, extra that has it
UNITS = {
    "cad/*.stl": ("mm", ("stl",)),
    "cad/*.step": ("mm", ("step",)),
    "cad/parts.3mf": ("mm", ("3mf",)),
    "cad/assembly.glb": ("m", ("glb",)),
    "cad/*.pdf": ("mm; A3, first angle", ("pdf",)),
    "cad/*.dxf": ("mm; A3, first angle", ("dxf",)),
    "robot/*": ("m, kg, rad; meshes mm, scaled where they are named", ROBOT),
    "ros2/*": ("m, kg, rad; meshes mm, scaled where they are named", ("ros2",)),
    "robot/flight.*": ("SI; the unit of each column in its name", LOG),
    "stress/*.vtu": ("m, Pa", ("vtu",)),
    "stress/*.msh": ("m", ("msh",)),
    "evaluation.json": ("SI; design values as in the study", FORMATS),
    "bom.csv": ("kg, kg/m3", FORMATS),
}


def parse_formats(text: str) -> tuple[str, ...]:
    """Formats named in a list with commas, each once; `log` and `all` stand for several.

    Raises: ExportError for one that is not known; LibraryError for one whose library is missing.
    """
    names = [name.strip().lower() for name in text.split(",") if name.strip()]
    known = (*FORMATS, *SHORT)
    for name in names:
        if name not in known:
            raise ExportError(f"--formats: no format {name!r}; {nearest(name, known)}")
    if not names:
        raise ExportError(f"--formats: name at least one of {', '.join(known)}")
    chosen = {one for name in names for one in SHORT.get(name, (name,))}
    for name, (module, extra) in LIBRARIES.items():
        if name in chosen and importlib.util.find_spec(module) is None:
            raise LibraryError(
                f"--formats: {name} needs {module}, which is not installed: pip install 'codesign[{extra}]', or name "
                "the formats without it"
            )
    return tuple(name for name in FORMATS if name in chosen)


def parse_frames(text: str) -> Frames:
    """What becomes of links without mass. Raises: ExportError for a word that is not known."""
    for known in FRAMES:
        if text == known:
            return known
    raise ExportError(f"--frames: {text!r} is none of {', '.join(FRAMES)}")


def units_of(formats: Collection[str], files: Collection[str]) -> dict[str, str]:
    """Units of the files that are written, by pattern; of the robot's only where there are some.

    formats: asked for. files: written, relative to the folder.
    """
    folders = {file.partition("/")[0] for file in files if "/" in file}
    return {
        pattern: unit
        for pattern, (unit, kinds) in UNITS.items()
        if any(kind in formats for kind in kinds) and ("/" not in pattern or pattern.partition("/")[0] in folders)
    }
