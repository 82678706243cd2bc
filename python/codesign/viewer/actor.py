"""One robot in the viewer's scene: its solids, its thrusts and its path, moved to any moment of its flight."""

from __future__ import annotations

from typing import Any

import numpy as np
import trimesh
from numpy.typing import NDArray
from trimesh.visual import TextureVisuals
from trimesh.visual.material import PBRMaterial

from codesign.report.details import Detail
from codesign.report.figures.flights import sample_at
from codesign.report.figures.solids import base_pose, stress_tint
from codesign.report.scene import Piece, RobotScene, round_number
from codesign.transforms import Matrix

ARROW_LENGTH = 0.33  # of the thrust arrows at the largest thrust, of the robot's size
LINE = 0.0065  # radius of arrows and paths, of the robot's size
SRGB_EXPONENT = 2.2  # of screen colors, roughly
PART = (0, 114, 178)
ARROW = (230, 122, 20)
PATH = (90, 98, 110)
REFERENCE = (190, 195, 200)

Array = NDArray[np.float64]


class Actor:
    """A robot under a node of the scene.

    Args:
        server: viser's.   root: name of the node that everything hangs from.
        scene, detail: the robot, its stress and flight.   offset: (3,) where it is shown beside its own place [m].
    """

    def __init__(self, server: Any, root: str, scene: RobotScene, detail: Detail, offset: Array) -> None:
        self.scene, self.flight, self._detail = scene, detail.flight, detail
        self._server, self._root, self._offset = server, root, offset
        self._parts: list[tuple[Any, Any]] = []
        self._paths: list[Any] = []
        self._compute_motion()
        frames = dict.fromkeys([*scene.links, *(scene.jets if self.flight is not None else ())])
        self._frames = {link: server.scene.add_frame(f"{root}/{link}", show_axes=False) for link in frames}
        for n, piece in enumerate(scene.pieces):
            self._add_piece(f"{root}/{piece.link}/{n}", piece)
        self._arrows = [self._add_arrow(jet) for jet in scene.jets] if self.flight is not None else []
        if self.flight is not None:
            self._add_path("reference", self.flight["com_reference"], REFERENCE)
            self._add_path("flown", self.flight["com"], PATH)
        self.pose(0.0)

    @property
    def newtons_per_meter(self) -> float:
        """Scale of the thrust arrows [N/m]."""
        return round_number(self.scene.max_thrust / (ARROW_LENGTH * self.scene.size))

    def position(self, link: str) -> tuple[float, float, float]:
        """Where a link is at the moment shown, world axes [m]."""
        x, y, z = self._frames[link].position
        return float(x), float(y), float(z)

    def part_center(self, part: str) -> tuple[Array, float]:
        """Middle (3,) of a part's first place at the moment shown, and its size [m]."""
        from scipy.spatial.transform import Rotation

        piece = next(piece for piece in self.scene.pieces if piece.part == part)
        low, high = piece.points.min(axis=0), piece.points.max(axis=0)
        turns, places = self._motion[piece.link]
        rotation = Rotation.from_quat(np.roll(turns[self.sample], -1)).as_matrix()
        return rotation @ ((low + high) / 2.0) + places[self.sample] + self._offset, float(np.linalg.norm(high - low))

    def pose(self, time: float) -> None:
        """Shows the robot as it is at a time of its flight [s]."""
        self.sample = sample_at(self.flight, time) if self.flight is not None else 0
        for link, frame in self._frames.items():
            turns, places = self._motion[link]
            frame.wxyz, frame.position = turns[self.sample], places[self.sample] + self._offset
        for n, arrow in enumerate(self._arrows):
            arrow.points = self._shafts[self.sample, n : n + 1]

    def show(self, stress: bool, thrusts: bool, path: bool) -> None:
        """Shows or hides the stress on the parts, the thrusts, the path."""
        for plain, stressed in self._parts:
            stressed.visible, plain.visible = stress, not stress
        for arrow in self._arrows:
            arrow.visible = thrusts
        for line in self._paths:
            line.visible = path

    def remove(self) -> None:
        """Takes the robot out of the scene."""
        self._server.scene.remove_by_name(self._root)

    def _compute_motion(self) -> None:
        """Places of all links, and arrows in the axes of their jets, at all samples."""
        flight = self.flight
        if flight is None:
            poses = self.scene.poses(None, np.eye(4)[None])
        else:
            poses = self.scene.poses(flight["joint_positions"], base_pose(flight, slice(None)))
            tips = self.scene.pushes * flight["thrust"][..., None] / self.newtons_per_meter
            self._shafts = np.stack([np.zeros_like(tips), tips], axis=2).astype(np.float32)
        self._motion = {link: _placed(poses[link]) for link in [*self.scene.links, *self.scene.jets]}

    def _add_piece(self, name: str, piece: Piece) -> None:
        """A solid in its color; a part with stresses a second time, in theirs."""
        points, triangles = piece.points.astype(np.float32), piece.triangles.astype(np.uint32)
        color = PART if piece.part else tuple(int(255 * c) for c in piece.color)
        plain = self._server.scene.add_mesh_simple(name, points, triangles, color=color, flat_shading=True)
        if piece.part is not None and piece.values is not None:
            highest = self._detail.parts[piece.part].peak  # what the safety factor is made from
            colored = tinted_mesh(piece.points, triangles, stress_tint(piece.values, highest))
            self._parts.append((plain, self._server.scene.add_mesh_trimesh(f"{name}_stress", colored)))

    def _add_arrow(self, jet: str) -> Any:
        """The thrust of a jet; it hangs from the jet's frame, so that it moves with it also between two samples."""
        line = LINE * self.scene.size
        return self._server.scene.add_arrows(
            f"{self._root}/{jet}/thrust", np.zeros((1, 2, 3)), ARROW, shaft_radius=line, head_radius=2.5 * line,
            head_length=5.0 * line,
        )  # fmt: skip

    def _add_path(self, name: str, points: Array, color: tuple[int, int, int]) -> None:
        segments = (np.stack([points[:-1], points[1:]], axis=1) + self._offset).astype(np.float32)
        line = self._server.scene.add_line_segments(
            f"{self._root}/path/{name}", segments, color, thickness=LINE * self.scene.size
        )
        self._paths.append(line)


def tinted_mesh(points: Array, triangles: NDArray[Any], colors: NDArray[Any]) -> trimesh.Trimesh:
    """A mesh with a color (n, 3), 0 … 1, at each point; its material is no metal, which is black without a sky."""
    material = PBRMaterial(metallicFactor=0.0, roughnessFactor=0.9)  # type: ignore[no-untyped-call]
    visual = TextureVisuals(material=material)  # type: ignore[no-untyped-call]
    linear = np.column_stack([colors**SRGB_EXPONENT, np.ones(len(colors))])  # as glTF has it
    visual.vertex_attributes["color"] = np.rint(255 * linear).astype(np.uint8)
    return trimesh.Trimesh(points, triangles, visual=visual, process=False)


def _placed(poses: Matrix) -> tuple[Array, Array]:
    """Unit quaternions (k, 4) as w, x, y, z and positions (k, 3) of poses (k, 4, 4)."""
    return quaternions(poses[:, :3, :3]), np.ascontiguousarray(poses[:, :3, 3])


def quaternions(rotations: Array) -> Array:
    """Unit quaternions (k, 4) as w, x, y, z of rotations (k, 3, 3)."""
    from scipy.spatial.transform import Rotation

    return np.asarray(np.roll(Rotation.from_matrix(rotations).as_quat(), 1, axis=1))
