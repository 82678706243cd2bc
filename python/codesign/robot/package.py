"""Mesh files of a robot description: found without leaving the folders allowed, and exported as a package folder."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any

from codesign.errors import UrdfError
from codesign.files import temporary_folder, write_text
from codesign.geometry.mesh_files import obj_text
from codesign.robot.description import RobotDescription
from codesign.robot.formats.ros2 import cmake_text, package_xml, require_ros_name
from codesign.robot.mesh_companions import companions

if TYPE_CHECKING:
    import trimesh

MeshWriter = Callable[[Path], object]


def resolve_mesh(filename: str, directory: Path | None = None, packages: Sequence[Path] = ()) -> Path:
    """File that a mesh reference of a URDF means.

    Args:
        filename: relative path, package://name/path, or file:// and absolute paths.
        directory: folder of the URDF; relative paths start here.
        packages: folders that hold packages, or are one (folder name = package name).
    Raises: UrdfError if there is no such file, the scheme is unknown, or the path (links followed) lies outside all of
    these folders.
    """
    candidates = _candidates(filename, directory, packages)
    inside = [path for root, path in candidates if path.resolve().is_relative_to(root.resolve())]
    if candidates and not inside:
        raise UrdfError(f"mesh {filename!r}: the path leaves the folders it may be read from")
    for path in inside:
        if path.is_file():
            return path.resolve()
    where = ", ".join(str(path) for path in inside) or "no search path given"
    raise UrdfError(f"mesh {filename!r}: not found ({where})")


def load_mesh(robot: RobotDescription, link: str, filename: str) -> trimesh.Trimesh:
    """A mesh of a robot, all its bodies as one, in the units of its file.

    Raises: UrdfError naming the link if it is not found or cannot be read.
    """
    import trimesh  # a second to load, needed for meshes alone

    try:
        path = resolve_mesh(filename, robot.directory)
        mesh: Any = trimesh.load(path, force="mesh")
    except UrdfError as error:
        raise UrdfError(f"link {link}: {error}") from error
    except (ValueError, KeyError, IndexError, OSError, ImportError) as error:
        raise UrdfError(f"link {link}: mesh {filename!r} cannot be read: {error}") from error
    if not isinstance(mesh, trimesh.Trimesh) or not len(mesh.faces):
        raise UrdfError(f"link {link}: mesh {filename!r} has no triangles")
    return mesh


def with_obj_meshes(robot: RobotDescription) -> RobotDescription:
    """The robot with every mesh as OBJ, which all simulators read; written beside the files of other formats.

    Its meshes must have paths relative to the robot's folder, as `write_urdf_package` gives them.

    Raises: UrdfError if a mesh is not found beside the robot or cannot be read.
    """
    renamed = {name: name for _, name in robot.mesh_filenames() if name.lower().endswith(".obj")}
    for link, filename in robot.mesh_filenames():
        if filename in renamed:
            continue
        mesh = load_mesh(robot, link, filename)
        path = resolve_mesh(filename, robot.directory)
        target = path.with_name(_unique_name(f"{path.stem}.obj", renamed))
        write_text(target, obj_text(mesh.vertices, mesh.faces))
        renamed[filename] = "".join(filename.rpartition("/")[:2]) + target.name
    return robot.with_mesh_filenames(renamed)


def _candidates(filename: str, directory: Path | None, packages: Sequence[Path]) -> list[tuple[Path, Path]]:
    """(folder it must lie in, path) of every file that a mesh reference can mean."""
    scheme, separator, rest = filename.partition("://")
    home = [] if directory is None else [directory]
    if not separator and not Path(filename).is_absolute():
        return [(root, root / filename) for root in home]
    if scheme == "file" or not separator:
        return [(root, Path(rest if separator else filename)) for root in (*home, *packages)]
    if scheme != "package":
        raise UrdfError(f"mesh {filename!r}: scheme {scheme!r} is not supported (package, file, or a relative path)")
    name, _, path = rest.partition("/")
    if name in ("", ".", ".."):
        raise UrdfError(f"mesh {filename!r}: no package name")
    found = [(root / name, root / name / path) for root in packages]
    return found + [(root, root / path) for root in packages if root.resolve().name == name]


def write_urdf_package(
    robot: RobotDescription,
    out_dir: str | Path,
    meshes: Mapping[str, MeshWriter] | None = None,
    package: str | None = None,
    packages: Sequence[Path] = (),
) -> Path:
    """Writes `robot.urdf` and `meshes/` into a folder, whole or not at all; returns the path of the URDF.

    Args:
        robot: what to write; every mesh it names ends up in `meshes/`.
        out_dir: made if absent; existing files of the same names are replaced, others are left alone.
        meshes: mesh filename as the robot names it -> function that writes that file (`part.write_stl`). Meshes not
            given are copied from where `resolve_mesh` finds them, with the materials, textures and buffers they name.
        package: name of the ROS package: meshes are then referenced as package://name/meshes/…, and what `colcon build`
            needs is written; the folder must be named the same to be found without. By default paths are relative.
        packages: where package:// references of the robot are looked for.
    Raises: UrdfError naming link and mesh if one is missing or outside the search path, or for a package name that ROS
    does not take.
    """
    if package is not None:
        require_ros_name(package)
    out_dir = Path(out_dir)
    out_dir.parent.mkdir(parents=True, exist_ok=True)
    with temporary_folder(out_dir) as staged:
        (staged / "meshes").mkdir()
        prefix = "meshes/" if package is None else f"package://{package}/meshes/"
        renamed: dict[str, str] = {}
        for link, filename in robot.mesh_filenames():
            if filename not in renamed:
                name = _unique_name(filename, renamed)
                renamed[filename] = prefix + _stage_mesh(
                    robot, link, filename, staged / "meshes" / name, meshes or {}, packages
                )
        robot.with_mesh_filenames(renamed).write(staged / "robot.urdf")
        if package is not None:
            write_text(staged / "package.xml", package_xml(package, f"URDF and meshes of {robot.name}"))
            write_text(staged / "CMakeLists.txt", cmake_text(package, ["meshes"], ["robot.urdf"]))
        _move_into(staged, out_dir)
    return out_dir / "robot.urdf"


def _stage_mesh(
    robot: RobotDescription,
    link: str,
    filename: str,
    target: Path,
    meshes: Mapping[str, MeshWriter],
    packages: Sequence[Path],
) -> str:
    """Writes or copies a mesh; returns its path in the folder of the target.

    A mesh that needs other files (materials, textures, buffers) gets a folder of its own, named as the target, in which
    they lie as they did, so that no reference in them changes.
    """
    if filename in meshes:
        meshes[filename](target)
        return target.name
    try:
        source = resolve_mesh(filename, robot.directory, packages)
        allowed = [*([] if robot.directory is None else [robot.directory]), *packages]
        others = companions(source, [*allowed, source.parent])
    except UrdfError as error:
        raise UrdfError(f"link {link}: {error}") from error
    if not others:
        shutil.copyfile(source, target)
        return target.name
    common = Path(os.path.commonpath([path.parent for path in (source, *others)]))
    for path in (source, *others):
        copy = target / path.relative_to(common)
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(path, copy)
    return f"{target.name}/{source.relative_to(common).as_posix()}"


def _unique_name(filename: str, renamed: Mapping[str, str]) -> str:
    name = PurePosixPath(filename.partition("://")[2] or filename)
    below = (path.rpartition("meshes/")[2] if "meshes/" in path else path for path in renamed.values())
    taken = {name for path in below for name in (PurePosixPath(path).parts[0], PurePosixPath(path).name)}
    unique, number = name.name, 1
    while unique in taken or not unique:
        number += 1
        unique = f"{name.stem}_{number}{name.suffix}"
    return unique


def _move_into(staged: Path, out_dir: Path) -> None:
    """Meshes first, the URDF last: whoever sees the new URDF finds its meshes."""
    (out_dir / "meshes").mkdir(parents=True, exist_ok=True)
    files = sorted((path for path in staged.rglob("*") if path.is_file()), key=lambda path: path.name == "robot.urdf")
    for path in files:
        target = out_dir / path.relative_to(staged)
        target.parent.mkdir(parents=True, exist_ok=True)
        path.replace(target)
