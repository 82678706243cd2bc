"""Real link meshes of a robot, where its model package is installed: what pictures show instead of plain shapes."""

from __future__ import annotations

import functools
import logging
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from codesign.errors import UrdfError
from codesign.robot.description import RobotDescription
from codesign.robot.package import resolve_mesh
from codesign.transforms import Matrix

logger = logging.getLogger(__name__)

# Where packages are looked for: variable -> folder below each of its entries that holds packages.
SEARCH_PATHS = {
    "ROS_PACKAGE_PATH": "", "AMENT_PREFIX_PATH": "share", "CMAKE_PREFIX_PATH": "share", "GAZEBO_MODEL_PATH": "",
    "GZ_SIM_RESOURCE_PATH": "", "IGN_GAZEBO_RESOURCE_PATH": "",
}  # fmt: skip

LinkMesh = tuple[Any, Any]  # points (n, 3) [m] in link axes, triangles (m, 3)


def package_paths(environment: Mapping[str, str] | None = None) -> tuple[Path, ...]:
    """Folders that hold packages, by the usual variables of ROS, colcon and Gazebo."""
    environment = os.environ if environment is None else environment
    found = [
        Path(entry) / below
        for variable, below in SEARCH_PATHS.items()
        for entry in environment.get(variable, "").split(os.pathsep)
        if entry
    ]
    return tuple(dict.fromkeys(path for path in found if path.is_dir()))


@dataclass(frozen=True, slots=True)
class LinkMeshes:
    """meshes: link -> its solids in link axes. poses: root_T_link (4, 4) of that model, all joints at zero."""

    meshes: dict[str, list[LinkMesh]]
    poses: dict[str, Matrix]


@functools.lru_cache(maxsize=4)
def link_meshes(visuals: str, packages: tuple[Path, ...]) -> LinkMeshes:
    """Meshes of the links of the URDF `visuals` (package://…); none if its package is not found.

    None either, with a warning, if the URDF cannot be read. A link whose mesh is missing or unreadable is left out, so
    that its plain shape is shown.
    """
    nothing = LinkMeshes({}, {})
    if not visuals or not packages:
        return nothing
    try:
        path = resolve_mesh(visuals, packages=packages)
    except UrdfError:
        return nothing
    try:
        robot = RobotDescription.load(path, as_published=True)
    except UrdfError as error:
        logger.warning("plain shapes are drawn instead of %s: %s", visuals, error)
        return nothing
    found: dict[str, list[LinkMesh]] = {}
    for link in robot.link_names:
        for visual in robot.link(link).visuals:
            if visual.geometry is not None and visual.geometry.mesh is not None:
                mesh = read_mesh(visual, path.parent, packages)
                if mesh is not None:
                    found.setdefault(link, []).append(mesh)
    return LinkMeshes(found, robot.frame_poses())


def read_mesh(visual: Any, folder: Path | None, packages: tuple[Path, ...]) -> LinkMesh | None:
    """The mesh of a URDF visual in link axes; None if it is not found or cannot be read."""
    import trimesh

    mesh = visual.geometry.mesh
    try:
        loaded = trimesh.load_mesh(resolve_mesh(mesh.filename, folder, packages))
    except (UrdfError, OSError, ValueError, NotImplementedError, ImportError):
        return None
    if not isinstance(loaded, trimesh.Trimesh) or not len(loaded.faces):
        return None
    scale = np.ones(3) if mesh.scale is None else np.broadcast_to(np.asarray(mesh.scale, dtype=float), 3)
    origin = np.eye(4) if visual.origin is None else visual.origin
    points = np.asarray(loaded.vertices) * scale @ origin[:3, :3].T + origin[:3, 3]
    return points, np.asarray(loaded.faces, dtype=np.int64)


def absent_meshes(robot: RobotDescription, packages: tuple[Path, ...]) -> list[str]:
    """File names of the robot's visual meshes that are not found or cannot be read, each once."""
    meshes: dict[str, Any] = {}
    for link in robot.link_names:
        for visual in robot.link(link).visuals:
            if visual.geometry is not None and visual.geometry.mesh is not None:
                meshes.setdefault(visual.geometry.mesh.filename, visual)
    return [name for name, visual in meshes.items() if read_mesh(visual, robot.directory, packages) is None]


def absence_in_words(absent: Sequence[str]) -> str:
    """That meshes are missing in the pictures, and what to install or set; empty if none is."""
    if not absent:
        return ""
    packages = sorted({name.removeprefix("package://").partition("/")[0] for name in absent if "package://" in name})
    files = [name for name in absent if "package://" not in name]
    said = (
        f"{len(absent)} mesh{'es' if len(absent) > 1 else ''} of the robot are not drawn: not found, or not readable."
    )
    if packages:
        these, them = ("packages", "them") if len(packages) > 1 else ("package", "it")
        variable = next(iter(SEARCH_PATHS))
        said += f" Install the {these} {', '.join(packages)}, or name the folder that holds {them} in {variable}."
    if files:
        said += f" Looked for {files[0]}{f' and {len(files) - 1} more' if len(files) > 1 else ''} beside the URDF."
    return said
