"""Motion of single links over a flight, and the wrench with which what hangs on a link pushes on it.

All from the robot's description and a history of base and joints: no plant, so it holds for every controller and jet.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from codesign.robot.description import RobotDescription
from codesign.robot.urdf_xml import MOVING
from codesign.transforms import Matrix, rotation_about

GRAVITY = np.array([0.0, 0.0, -9.81])  # m/s², world axes; as in the flight


@dataclass(frozen=True, slots=True, eq=False)
class RigidMotion:
    """Motion of a frame over n instants, world axes, SI. rotation: world_R_frame (n, 3, 3).

    position, velocity, acceleration: of its origin, (n, 3); angular_velocity, angular_acceleration: (n, 3).
    """

    rotation: Matrix
    position: Matrix
    velocity: Matrix
    angular_velocity: Matrix
    acceleration: Matrix
    angular_acceleration: Matrix

    def acceleration_at(self, offset: Matrix) -> Matrix:
        """(n, 3) acceleration of a point fixed to the frame, offset (n, 3) from its origin, world axes."""
        spin = self.angular_velocity
        turned = np.cross(self.angular_acceleration, offset) + np.cross(spin, np.cross(spin, offset))
        return np.asarray(self.acceleration + turned)


@dataclass(frozen=True, slots=True, eq=False)
class Thrust:
    """A jet over n instants. link: frame it sits in. axis: (3,) unit vector in it along which the thrust pushes.

    force: (n,) [N]. reaction: moment about the axis per force [N m/N].
    """

    link: str
    axis: Matrix
    force: Matrix
    reaction: float = 0.0


@dataclass(frozen=True, slots=True, eq=False)
class MotionHistory:
    """A robot over n instants. joints: names; positions, rates, accelerations: (n, joints) [rad or m, per s, per s²].

    base: motion of the root link. Moving joints that are not named stay at zero.
    """

    robot: RobotDescription
    base: RigidMotion
    joints: Sequence[str]
    positions: Matrix
    rates: Matrix
    accelerations: Matrix

    def motion(self, link: str) -> RigidMotion:
        """Motion of a link's frame."""
        motion = self.base
        for joint in self._path(link):
            motion = self._child(joint, motion)
        return motion

    def wrench_on(self, point: Matrix, links: Iterable[str], thrusts: Iterable[Thrust]) -> tuple[Matrix, Matrix]:
        """Force (n, 3) [N] and moment about `point` (n, 3) [N m] with which a group of links pushes on its holder.

        What is left of thrust and weight when the links have got their accelerations, world axes. point: (n, 3) [m].
        """
        force, moment = np.zeros_like(point), np.zeros_like(point)
        motions = {link: self.motion(link) for link in links}
        for link, motion in motions.items():
            inertial = self.robot.inertial(link)
            if inertial is None:
                continue
            offset = motion.rotation @ inertial.com
            pull = inertial.mass * (GRAVITY - motion.acceleration_at(offset))
            inertia = motion.rotation @ inertial.inertia @ motion.rotation.swapaxes(1, 2)
            spin = motion.angular_velocity
            turned = _times(inertia, motion.angular_acceleration) + np.cross(spin, _times(inertia, spin))
            force += pull
            moment += np.cross(motion.position + offset - point, pull) - turned
        for thrust in thrusts:
            if thrust.link in motions:
                motion = motions[thrust.link]
                push = (motion.rotation @ thrust.axis) * thrust.force[:, None]
                force += push
                moment += np.cross(motion.position - point, push) + thrust.reaction * push
        return force, moment

    def _path(self, link: str) -> list[str]:
        """Joints from the root to a link."""
        parents = {self.robot.joint(name).child: name for name in self.robot.joint_names}
        path = []
        while link != self.robot.root_link:
            path.append(parents[link])
            link = self.robot.joint_parent(parents[link])
        return path[::-1]

    def _joint_motion(self, name: str, kind: str) -> tuple[Matrix, Matrix, Matrix]:
        """Position, rate and acceleration (n,) of a joint; of one that mimics another, from that one."""
        followed, multiplier, offset = self.robot.mimics.get(name, (name, 1.0, 0.0))
        count = len(self.positions)
        if kind not in MOVING:
            return np.zeros(count), np.zeros(count), np.zeros(count)
        if followed not in self.joints:
            return np.full(count, offset), np.zeros(count), np.zeros(count)
        column = list(self.joints).index(followed)
        position, rate, acceleration = (v[:, column] for v in (self.positions, self.rates, self.accelerations))
        return multiplier * position + offset, multiplier * rate, multiplier * acceleration

    def _child(self, name: str, parent: RigidMotion) -> RigidMotion:
        joint = self.robot.joint(name)
        origin = self.robot.joint_origin(name)
        position, rate, acceleration = self._joint_motion(name, joint.type)
        frame = parent.rotation @ origin[:3, :3]
        axis = np.zeros(3) if joint.axis is None else np.asarray(joint.axis, dtype=float)
        axis = axis / (np.linalg.norm(axis) or 1.0)
        along = frame @ axis
        spin = parent.angular_velocity
        slides = joint.type == "prismatic"
        offset = parent.rotation @ origin[:3, 3] + (along * position[:, None] if slides else 0.0)
        velocity = parent.velocity + np.cross(spin, offset)
        linear = parent.acceleration_at(offset)
        turn, turning = rate[:, None] * along, acceleration[:, None] * along
        if slides:
            return RigidMotion(
                frame, parent.position + offset, velocity + turn, spin, linear + turning + 2.0 * np.cross(spin, turn),
                parent.angular_acceleration,
            )  # fmt: skip
        return RigidMotion(
            frame @ rotation_about(axis, position), parent.position + offset, velocity, spin + turn, linear,
            parent.angular_acceleration + turning + np.cross(spin, turn),
        )  # fmt: skip


def descendants(robot: RobotDescription, joint: str) -> list[str]:
    """The child of a joint and all links that hang from it."""
    children: dict[str, list[str]] = {}
    for name in robot.joint_names:
        children.setdefault(robot.joint_parent(name), []).append(robot.joint(name).child)
    links = [robot.joint(joint).child]
    for link in links:
        links += children.get(link, [])
    return links


def fixed_at(motion: RigidMotion, frame_T_body: Matrix) -> RigidMotion:
    """Motion of a body's frame that is fixed to a moving frame at frame_T_body (4, 4)."""
    offset = motion.rotation @ frame_T_body[:3, 3]
    return RigidMotion(
        motion.rotation @ frame_T_body[:3, :3],
        motion.position + offset,
        motion.velocity + np.cross(motion.angular_velocity, offset),
        motion.angular_velocity,
        motion.acceleration_at(offset),
        motion.angular_acceleration,
    )


def _times(matrices: Matrix, vectors: Matrix) -> Matrix:
    return np.asarray(np.einsum("nij,nj->ni", matrices, vectors))
