"""Clearance between bodies of a robot over the postures it takes, and between jet plumes and the robot.

Every link is the set of its primitive shapes; a part is given as convex pieces of its own surface. Watched
bodies (the parts, turbines) are measured against every other link they can meet; a plume is a truncated cone.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import product
from typing import Annotated, Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from codesign.dynamics import nearest_approaches
from codesign.errors import StudyError, UrdfError
from codesign.robot.assembly import PartPlacement, place_points
from codesign.robot.description import RobotDescription
from codesign.robot.hulls import smallest_axis_angle
from codesign.robot.urdf_elements import Shape
from codesign.transforms import Matrix, inverse
from codesign.units import DEGREE, MILLIMETER

Indices = NDArray[np.intp]
Pieces = Mapping[str, Sequence[Matrix]]  # link -> points (n, 3) of each convex piece, link axes [m]
CYLINDER_SIDES = 32  # inscribed: up to 0.5 % of the radius inside the true cylinder or sphere
_TURNS = np.arange(CYLINDER_SIDES) * 2.0 * np.pi / CYLINDER_SIDES
_CIRCLE = np.column_stack([np.cos(_TURNS), np.sin(_TURNS)])


class PlumeSettings(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Jet plume along +z of each jet frame: a truncated cone from the nozzle.

    half_angle_deg: 11.8° is the visible edge of a free turbulent round jet (Cushman-Roisin, "Environmental Fluid
    Mechanics", turbulent jets). start_mm: gap between frame origin and cone, which so does not touch the nozzle.
    """

    jets: tuple[str, ...] = ()
    half_angle_deg: Annotated[float, msgspec.Meta(ge=0, lt=90)] = 11.8
    radius_mm: Annotated[float, msgspec.Meta(gt=0)] = 34.0
    start_mm: Annotated[float, msgspec.Meta(ge=0)] = 5.0
    length_mm: Annotated[float, msgspec.Meta(gt=0)] = 1000.0


SLICES = 8  # convex pieces of a part


class InterferenceSettings(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What is measured.

    bodies: watched links. ignore: pairs of links that touch by design. report_below_mm: pairs that stay farther apart
    in all postures are left out of the report. postures: how many of a flight, evenly in time, beside those where a
    joint is at its ends. slices: convex pieces of each part.
    """

    bodies: tuple[str, ...]
    ignore: tuple[tuple[str, str], ...] = ()
    plumes: PlumeSettings = PlumeSettings()
    report_below_mm: Annotated[float, msgspec.Meta(gt=0)] = 50.0
    postures: Annotated[int, msgspec.Meta(ge=1, le=100_000)] = 50
    slices: Annotated[int, msgspec.Meta(ge=1, le=1000)] = SLICES


@dataclass(frozen=True, slots=True)
class Clearance:
    """Smallest distance [m] of two links, or of a plume (named after its jet) and a link.

    Where they overlap, minus the shortest translation that parts them. posture: where it occurs, index. angle: plumes
    only, smallest angle between the jet axis and the link, seen from the nozzle, in that posture [rad].
    """

    first: str
    second: str
    distance: float
    posture: int
    angle: float | None = None


@dataclass(frozen=True, slots=True)
class InterferenceReport:
    """Pairs and plumes below the reporting distance, nearest first.

    min_clearance, min_plume_clearance [m]: the smallest of each; the reporting distance if all are farther.
    """

    clearances: tuple[Clearance, ...]
    plumes: tuple[Clearance, ...]
    min_clearance: float
    min_plume_clearance: float


def range_postures(ranges: Mapping[str, tuple[float, float]], count: int, seed: int = 0) -> dict[str, Matrix]:
    """Postures spread over joint ranges [rad]: the middle, both ends of every joint alone, and `count` Sobol points."""
    names = list(ranges)
    lower, upper = np.array([ranges[name] for name in names], dtype=float).T
    middle = 0.5 * (lower + upper)
    ends = np.tile(middle, (2 * len(names), 1))
    ends[np.arange(len(names)), np.arange(len(names))] = lower
    ends[len(names) + np.arange(len(names)), np.arange(len(names))] = upper
    from scipy.stats import qmc  # 0.4 s to import, needed here only

    sobol = qmc.Sobol(len(names), seed=seed).random_base2(max(0, int(np.ceil(np.log2(max(count, 1))))))[:count]
    samples = np.vstack([middle, ends, lower + sobol * (upper - lower)])
    return {name: samples[:, k] for k, name in enumerate(names)}


def telling_samples(history: Matrix, count: int) -> Indices:
    """Rows of a flown history (n, joints) where each joint is at its ends, and `count` evenly in time; ascending."""
    even = np.linspace(0, len(history) - 1, count).round().astype(np.intp)
    joints = np.ascontiguousarray(history.T)
    return np.unique(np.concatenate([joints.argmin(axis=1), joints.argmax(axis=1), even]))


def link_pieces(robot: RobotDescription, given: Pieces) -> dict[str, list[Matrix]]:
    """Convex pieces of every link that has a shape, link axes: those given, else the link's primitives.

    Raises: UrdfError for a link whose shape is a mesh and for which no pieces are given.
    """
    pieces = {}
    for name in robot.link_names:
        if name in given:
            pieces[name] = [np.asarray(points, dtype=float) for points in given[name]]
        elif visuals := robot.link(name).visuals:
            pieces[name] = [shape_points(name, visual) for visual in visuals]
    return pieces


def check_interference(
    robot: RobotDescription,
    settings: InterferenceSettings,
    postures: Mapping[str, Matrix],
    pieces: Pieces | None = None,
) -> InterferenceReport:
    """Clearances of the watched bodies and of the plumes over postures.

    postures: joint name -> (n,) positions [rad]; joints not named stay at zero. pieces: convex pieces of links in link
    axes, instead of the link's visuals.
    Raises: StudyError if a watched or ignored link or a jet is not there; UrdfError as `link_pieces` does.
    """
    shapes = link_pieces(robot, pieces or {})
    _require_links(robot, shapes, settings)
    count = len(next(iter(postures.values()))) if postures else 1
    poses = posture_poses(robot, postures, count)
    limit = settings.report_below_mm * MILLIMETER
    contacts = pair_clearances(shapes, poses, _body_pairs(robot, shapes, settings), limit)
    plume_shapes = shapes | {jet + PLUME: [_plume_hull(settings.plumes)] for jet in settings.plumes.jets}
    plume_poses = poses | {jet + PLUME: poses[jet] for jet in settings.plumes.jets}
    plume_pairs = [(jet + PLUME, link) for jet in settings.plumes.jets for link in shapes if link != jet]
    plumes = [
        _with_angle(found, plume_shapes, plume_poses)
        for found in pair_clearances(plume_shapes, plume_poses, plume_pairs, limit)
    ]
    nearest = (min((c.distance for c in found), default=limit) for found in (contacts, plumes))
    return InterferenceReport(tuple(contacts), tuple(plumes), *nearest)


def flown_interference(
    robot: RobotDescription,
    settings: InterferenceSettings,
    parts: Mapping[str, tuple[Sequence[PartPlacement], Sequence[Matrix]]],
    joints: Sequence[str],
    history: Matrix,
    times: Matrix,
) -> dict[str, Any]:
    """Clearances of a flown design for JSON, SI units: both minima, and every pair and plume below the limit.

    robot: with the design's parts in it. parts: name -> its places and its convex pieces, part axes [m].
    joints, history: joint names, and positions (n, joints) [rad] at times (n,) [s].
    """
    pieces: dict[str, list[Matrix]] = {}
    for places, slices in parts.values():
        pieces |= {place.link: [place_points(place, points) for points in slices] for place in places}
    chosen = telling_samples(history, settings.postures)
    postures = {name: history[chosen, k] for k, name in enumerate(joints)}
    report = check_interference(robot, settings, postures, pieces)
    chosen_times = [float(times[row]) for row in chosen]
    return {
        "body_clearance": report.min_clearance,
        "plume_clearance": report.min_plume_clearance,
        "bodies": [
            {"links": [c.first, c.second], "clearance": c.distance, "time": chosen_times[c.posture]}
            for c in report.clearances
        ],
        "plumes": [
            {
                "jet": c.first,
                "link": c.second,
                "clearance": c.distance,
                "angle": c.angle,
                "time": chosen_times[c.posture],
            }
            for c in report.plumes
        ],
    }


PLUME = " plume"


def _require_links(robot: RobotDescription, shapes: Mapping[str, object], settings: InterferenceSettings) -> None:
    for name in (*settings.bodies, *(link for pair in settings.ignore for link in pair)):
        if name not in shapes:
            raise StudyError(f"interference: the robot has no link {name!r} with a shape")
    for jet in settings.plumes.jets:
        if jet not in robot.link_names:
            raise StudyError(f"interference: the robot has no jet frame {jet!r}")


def _body_pairs(
    robot: RobotDescription, shapes: Mapping[str, object], settings: InterferenceSettings
) -> list[tuple[str, str]]:
    ignored = {frozenset(pair) for pair in settings.ignore}
    ignored |= {frozenset((robot.joint(j).parent, robot.joint(j).child)) for j in robot.joint_names}
    pairs = {frozenset((body, link)) for body in settings.bodies for link in shapes if link != body} - ignored
    order = list(shapes)
    number = {name: k for k, name in enumerate(order)}
    numbers = sorted(sorted(number[name] for name in pair) for pair in pairs)
    return [(order[i], order[j]) for i, j in numbers]


def posture_poses(robot: RobotDescription, postures: Mapping[str, Matrix], count: int) -> dict[str, Matrix]:
    """root_T_link (count, 4, 4) of every link."""
    poses = robot.frame_poses(postures)
    return {name: pose if pose.ndim == 3 else np.repeat(pose[None], count, axis=0) for name, pose in poses.items()}


def pair_clearances(
    shapes: Mapping[str, Sequence[Matrix]], poses: Mapping[str, Matrix], pairs: Sequence[tuple[str, str]], limit: float
) -> list[Clearance]:
    """Smallest signed distance [m] of each pair over all postures, where it is below `limit`; nearest first."""
    if not pairs:
        return []
    names = list(dict.fromkeys(name for pair in pairs for name in pair))
    number = {name: k for k, name in enumerate(names)}
    numbers = np.array([[number[name] for name in pair] for pair in pairs])
    placed = np.stack([poses[name] for name in names])
    distances, postures = nearest_approaches([list(shapes[name]) for name in names], placed, numbers, limit)
    found = [
        Clearance(*pair, distance, posture)
        for pair, distance, posture in zip(pairs, distances.tolist(), postures.tolist(), strict=True)
        if distance < limit
    ]
    return sorted(found, key=lambda clearance: clearance.distance)


def _with_angle(found: Clearance, shapes: Mapping[str, Sequence[Matrix]], poses: Mapping[str, Matrix]) -> Clearance:
    """The clearance of a plume with its jet's name and the smallest angle to the link."""
    jet_T_link = inverse(poses[found.first][found.posture]) @ poses[found.second][found.posture]
    angle = smallest_axis_angle(shapes[found.second], jet_T_link)
    return Clearance(found.first.removesuffix(PLUME), found.second, found.distance, found.posture, angle)


def _plume_hull(settings: PlumeSettings) -> Matrix:
    start, length = settings.start_mm * MILLIMETER, settings.length_mm * MILLIMETER
    radius = settings.radius_mm * MILLIMETER
    wide = radius + (length - start) * np.tan(settings.half_angle_deg * DEGREE)
    return np.vstack([_ring(radius, start), _ring(wide, length)])


def _ring(radius: float, z: float) -> Matrix:
    return np.hstack([radius * _CIRCLE, np.full((CYLINDER_SIDES, 1), z)])


@lru_cache(maxsize=512)
def _cylinder_points(radius: float, length: float) -> Matrix:
    """About the z axis; kept, as most of a robot is the same in every design."""
    return np.vstack([_ring(radius, z) for z in (-0.5 * length, 0.5 * length)])


@lru_cache(maxsize=1)
def _sphere_points() -> Matrix:
    heights = np.sin(np.linspace(-np.pi / 2, np.pi / 2, CYLINDER_SIDES // 2 + 1))
    return np.vstack([_ring(np.sqrt(1.0 - z * z), z) for z in heights])


_CUBE = np.array(list(product((-0.5, 0.5), repeat=3)))


def shape_points(link: str, drawn: Shape, radius_scale: float = 1.0) -> Matrix:
    """Points (n, 3) of a primitive shape of a link, link axes [m]; rounds are polygons in the circle, times a scale.

    Raises: UrdfError if the shape is a mesh.
    """
    shape = drawn.geometry
    if shape.box is not None:
        points = _CUBE * shape.box.size
    elif shape.cylinder is not None:
        points = _cylinder_points(radius_scale * shape.cylinder.radius, shape.cylinder.length)
    elif shape.sphere is not None:
        points = radius_scale * shape.sphere.radius * _sphere_points()
    else:
        raise UrdfError(f"link {link}: its shape is a mesh; give its convex pieces")
    origin = np.eye(4) if drawn.origin is None else drawn.origin
    return np.asarray(points @ origin[:3, :3].T + origin[:3, 3])
