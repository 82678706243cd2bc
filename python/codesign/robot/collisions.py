"""Pairs of links whose collision shapes may touch: neighbors, and shapes that overlap where the robot flies.

Robots are drawn and collided with boxes and cylinders that reach into each other. A contact simulator that does not
know which of them to leave out pushes the robot apart.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations

import numpy as np

from codesign.robot.bodies import child_joints, rigid_bodies
from codesign.robot.clearance import CYLINDER_SIDES, pair_clearances, posture_poses, shape_points
from codesign.robot.description import RobotDescription
from codesign.robot.hulls import hull_vertices
from codesign.robot.package import load_mesh
from codesign.robot.urdf_elements import Shape
from codesign.robot.urdf_xml import MOVING
from codesign.transforms import Matrix

Pairs = Mapping[tuple[str, str], str]  # two links -> why their collisions are left out, as an SRDF says it
ADJACENT, OVERLAPPING = "Adjacent", "Default"
GAP = 1e-3  # m; shapes nearer than this count as overlapping, so that no reader's tolerance decides
CIRCUMSCRIBED = 1.0 / np.cos(np.pi / CYLINDER_SIDES) ** 2  # polyhedra around round shapes, not in them


def ignored_pairs(robot: RobotDescription, postures: Mapping[str, Matrix]) -> dict[tuple[str, str], str]:
    """Pairs of links with collision shapes whose contacts mean nothing, in the links' order.

    Adjacent: links of one rigid body, or of two that a moving joint joins. Default: shapes that come nearer than 1 mm
    in one of the postures. A mesh counts as its convex hull, as in most contact simulators.

    postures: joint name -> (n,) positions [rad, m]; joints not named stay at zero.
    Raises: UrdfError if a mesh cannot be found or read.
    """
    shapes = collision_hulls(robot)
    order = list(shapes)
    adjacent = _adjacent(robot)
    body = rigid_bodies(robot)
    pairs = list(combinations(order, 2))
    near = [pair for pair in pairs if frozenset(body[link] for link in pair) in adjacent]
    others = [pair for pair in pairs if pair not in set(near)]
    count = len(next(iter(postures.values()))) if postures else 1
    poses = posture_poses(robot, postures, count)
    overlapping = {(c.first, c.second) for c in pair_clearances(shapes, poses, others, GAP)}
    reasons = {**dict.fromkeys(near, ADJACENT), **dict.fromkeys(overlapping, OVERLAPPING)}
    return {pair: reasons[pair] for pair in pairs if pair in reasons}


def collision_hulls(robot: RobotDescription) -> dict[str, list[Matrix]]:
    """Points (n, 3) of every collision shape of every link that has one, link axes [m]; hulls contain the shapes."""
    hulls = {}
    for name in robot.link_names:
        if collisions := robot.link(name).collisions:
            hulls[name] = [_points(robot, name, shape) for shape in collisions]
    return hulls


def _points(robot: RobotDescription, link: str, shape: Shape) -> Matrix:
    mesh = shape.geometry.mesh
    if mesh is None:
        return shape_points(link, shape, CIRCUMSCRIBED)
    points = hull_vertices(
        load_mesh(robot, link, mesh.filename).vertices * np.ravel(1.0 if mesh.scale is None else mesh.scale)
    )
    origin = shape.origin
    return points if origin is None else points @ origin[:3, :3].T + origin[:3, 3]


def _adjacent(robot: RobotDescription) -> set[frozenset[str]]:
    """First links of rigid bodies that a moving joint joins, and of each body with itself."""
    body = rigid_bodies(robot)
    joined = {frozenset((first,)) for first in body.values()}
    for link, joints in child_joints(robot).items():
        joined |= {
            frozenset((body[link], robot.joint(name).child)) for name in joints if robot.joint(name).type in MOVING
        }
    return joined
