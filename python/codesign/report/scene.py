"""The robot of a design as solids that can be drawn: link shapes, the design's parts, postures, jets."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from codesign.problem.design_space import DesignValue
from codesign.report.link_meshes import LinkMesh, link_meshes, package_paths, read_mesh
from codesign.robot.assembly import PartPlacement
from codesign.robot.description import RobotDescription
from codesign.transforms import Matrix

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

PLAIN = (0.72, 0.74, 0.77)  # of shapes without a color
DOWN = (0.0, 0.0, -1.0)  # along which a thrust pushes unless the study says otherwise
SEGMENTS = 40  # of a round shape


@dataclass(frozen=True, slots=True, eq=False)
class Piece:
    """A solid fixed to a link: points (n, 3) [m] in link axes, triangles (m, 3), color 0 … 1.

    part: the design's part that it is, None for the robot's own shapes.   values: (n,) what may color it, say stress.
    """

    link: str
    points: Array
    triangles: Indices
    color: tuple[float, float, float] = PLAIN
    part: str | None = None
    values: Array | None = None


@dataclass(frozen=True, eq=False)
class RobotScene:
    """Everything to draw a robot.

    jets: frames that thrusts act on, along the unit vectors `pushes` (jets, 3) of these frames. max_thrust: of the
    strongest [N]. propellers: thrusts come from propellers, which have no flame.
    """

    robot: RobotDescription
    pieces: tuple[Piece, ...]
    jets: tuple[str, ...] = ()
    joints: tuple[str, ...] = field(default=())
    pushes: Array = field(default_factory=lambda: np.empty((0, 3)))
    max_thrust: float = 1.0
    propellers: bool = False

    @cached_property
    def links(self) -> tuple[str, ...]:
        """Links that carry a piece."""
        return tuple(dict.fromkeys(piece.link for piece in self.pieces))

    @cached_property
    def size(self) -> float:
        """Diagonal of the box around the robot with all joints at zero [m]; 1 if there is nothing to draw."""
        poses = self.poses()
        points = [p.points @ poses[p.link][:3, :3].T + poses[p.link][:3, 3] for p in self.pieces]
        return float(np.linalg.norm(np.ptp(np.concatenate(points), axis=0))) if points else 1.0

    def poses(self, joint_positions: Any = None, base: Matrix | None = None) -> dict[str, Matrix]:
        """world_T_link of every link: (4, 4), or (k, 4, 4) for joint positions (k, joints) and base poses (k, 4, 4).

        None: all joints at zero, the base at the world's origin.
        """
        named: Mapping[str, Any] = {}
        if joint_positions is not None:
            named = {name: joint_positions[..., i] for i, name in enumerate(self.joints)}
        local = self.robot.frame_poses(named)
        root = np.eye(4) if base is None else base
        return {link: root @ pose for link, pose in local.items()}


def robot_scene(
    study: Any,
    design: Mapping[str, DesignValue],
    fields: Mapping[str, Any] | None = None,
    packages: tuple[Path, ...] | None = None,
) -> RobotScene:
    """The robot with a design's parts.

    Args:
        fields: part -> `details.StressField`: drawn instead of the part's surface, its stress as the pieces' values.
        packages: folders where the robot's real link meshes are looked for; by default those of `package_paths`.
    Raises: CodesignError if a part or the robot cannot be built.
    """
    checked = study.space.design(design)
    config = study.configured(checked)
    robot = RobotDescription.from_text(study.build_robot(checked), directory=study.base_robot.directory)
    packages = package_paths() if packages is None else packages
    parts = study.build_parts(checked)
    placed: dict[str, list[Piece]] = {}
    for part in config.parts:
        alone = [PartPlacement(link=robot.link_names[0])] if config.robot is None else []
        for place in part.placements or alone:
            piece = _part_piece(part.name, parts[part.name], place, (fields or {}).get(part.name))
            placed.setdefault(place.link, []).append(piece)
    real = _real_shapes(robot, frozenset(placed), config.robot.visuals if config.robot else "", packages)
    colors = _materials(robot)
    pieces: list[Piece] = []
    for link in robot.link_names:
        own = _link_pieces(robot, link, colors, packages)
        if own and link in real:
            own = [Piece(link, points, triangles, own[0].color) for points, triangles in real[link]]
        pieces += placed.get(link) or own
    if config.flight is None:
        return RobotScene(robot, tuple(pieces), (), (), np.zeros((0, 3)), 1.0)
    joints = tuple(joint for group in config.flight.joint_groups for joint in group.joints)
    jets = config.flight.jets
    pushes = np.array(jets.axes or [DOWN] * len(jets.frames), dtype=float).reshape(-1, 3)
    strongest, propellers = float(np.max(jets.max_thrust_n)), jets.kind == "propeller"
    return RobotScene(robot, tuple(pieces), tuple(jets.frames), joints, pushes, strongest, propellers)


def round_number(value: float) -> float:
    """The nearest of 1, 2, 5 times a power of ten: for scales and grids. value > 0."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(power * min((1.0, 2.0, 5.0, 10.0), key=lambda step: abs(np.log(step * power / value))))


def _real_shapes(
    robot: RobotDescription, parts: frozenset[str], visuals: str, packages: tuple[Path, ...]
) -> dict[str, list[LinkMesh]]:
    """Real meshes of the links, in this robot's link axes.

    The model that they come from may define a link's axes otherwise; both robots stand alike when all joints are at
    zero, but for what hangs from the design's `parts`.
    """
    found = link_meshes(visuals, packages)
    ours = robot.frame_poses()
    moved = with_descendants(robot, parts)
    shapes: dict[str, list[LinkMesh]] = {}
    for link, meshes in found.meshes.items():
        if link in ours:
            turn = np.eye(4) if link in moved else np.linalg.inv(ours[link]) @ found.poses[link]
            shapes[link] = [(points @ turn[:3, :3].T + turn[:3, 3], triangles) for points, triangles in meshes]
    return shapes


def _part_piece(name: str, part: Any, place: Any, stress: Any) -> Piece:
    if stress is None:
        surface = part.surface(96)
        points, triangles, values = np.asarray(surface.points), np.asarray(surface.triangles), None
    else:
        points, triangles, values = stress.points, stress.triangles, stress.von_mises
    if place.mirror is not None:
        points = points * np.where(np.arange(3) == "xyz".index(place.mirror), -1.0, 1.0)
        triangles = triangles[:, ::-1]
    pose = place.link_T_part.matrix()
    return Piece(
        place.link, points @ pose[:3, :3].T + pose[:3, 3], triangles.astype(np.int64), part=name, values=values
    )


def with_descendants(robot: RobotDescription, links: Iterable[str]) -> set[str]:
    """The links and all that hang from them."""
    children: dict[str, list[str]] = {}
    for joint in robot.joint_names:
        children.setdefault(robot.joint_parent(joint), []).append(str(robot.joint(joint).child))
    found, pending = set(links), list(links)
    while pending:
        below = children.get(pending.pop(), [])
        found.update(below)
        pending += below
    return found


def _materials(robot: RobotDescription) -> dict[str, tuple[float, float, float]]:
    """Colors of the robot's named materials."""
    return {name: (red, green, blue) for name, (red, green, blue, *_) in robot.material_colors().items()}


def _link_pieces(
    robot: RobotDescription,
    link: str,
    colors: Mapping[str, tuple[float, float, float]],
    packages: tuple[Path, ...],
) -> list[Piece]:
    """The link's own shapes and meshes; meshes that are not here are left out (`link_meshes.absent_meshes`)."""
    pieces = []
    for visual in robot.link(link).visuals:
        solid = _solid(robot, visual, packages)
        if solid is None:
            continue
        color = PLAIN
        if visual.material is not None:
            own = visual.material.color
            color = tuple(own.rgba[:3]) if own is not None else colors.get(visual.material.name or "", PLAIN)
        pieces.append(Piece(link, *solid, color))
    return pieces


def _solid(robot: RobotDescription, visual: Any, packages: tuple[Path, ...]) -> LinkMesh | None:
    """What a visual looks like, in link axes."""
    if visual.geometry is not None and visual.geometry.mesh is not None:
        return read_mesh(visual, robot.directory, packages)
    shape = _primitive(visual.geometry)
    if shape is None:
        return None
    origin = np.eye(4) if visual.origin is None else visual.origin
    points = np.asarray(shape.vertices) @ origin[:3, :3].T + origin[:3, 3]
    return points, np.asarray(shape.faces, dtype=np.int64)


def _primitive(geometry: Any) -> Any:
    from trimesh import creation

    if geometry is None:
        return None
    if geometry.box is not None:
        return creation.box(extents=geometry.box.size)
    if geometry.cylinder is not None:
        return creation.cylinder(geometry.cylinder.radius, geometry.cylinder.length, sections=SEGMENTS)
    if geometry.sphere is not None:
        return creation.icosphere(subdivisions=3, radius=geometry.sphere.radius)
    return None
