"""Where a robot gets its jets: arms with motors around its base, on named links, or to the propellers that it has."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from codesign.errors import UrdfError
from codesign.robot.description import RobotDescription
from codesign.robot.inertial import Inertial
from codesign.robot.urdf_xml import MOVING
from codesign.transforms import Matrix, inverse

PROPELLER_NAMES = re.compile(r"(?<![a-z])(rotor|prop(eller)?|jet|turbine|thruster|edf)(?![a-z])", re.IGNORECASE)
NEGLIGIBLE_MASS = 1e-3  # share of the robot's mass up to which a link's impossible inertia is mended
MENDED_RADIUS = 0.01  # m, radius of gyration that it gets
LEAST_RADIUS, BEYOND = 0.25, 0.10  # m: of the circle of jets around a robot; beyond its outermost link
HUB_SHARE = 0.35  # of the way from the middle to a jet, where its arm begins
UPRIGHT = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, slots=True)
class Mount:
    """One jet on an arm. arm, jet: links; joint: of the jet, hangs from the arm; length: hub to jet [m].

    along the axis.
    """

    arm: str
    jet: str
    joint: str
    length: float
    axis: tuple[float, float, float]
    jet_rotation: Matrix
    azimuth: float


def mended(robot: RobotDescription) -> tuple[RobotDescription, list[str]]:
    """The robot with possible inertias for links of negligible mass, and their names.

    Raises: UrdfError: a link of more mass has an inertia that no body can have.
    """
    names = []
    for link in robot.link_names:
        inertial = robot.inertial(link)
        if inertial is None:
            continue
        try:
            inertial.require_physical(link)
        except UrdfError:
            if not 0.0 <= inertial.mass <= NEGLIGIBLE_MASS * robot.total_mass:
                raise
            sphere = np.eye(3) * inertial.mass * MENDED_RADIUS**2
            robot = robot.replace_inertial(link, Inertial(inertial.mass, inertial.com, sphere))
            names.append(link)
    return robot, names


def propellers(robot: RobotDescription) -> list[str]:
    """Links that look like the propellers of a multirotor: by name, one joint from the base, and nothing else moves."""
    named = [link for link in robot.link_names if PROPELLER_NAMES.search(link.replace("_", " "))]
    own = {joint: robot.joint(joint).child for joint in robot.joint_names}
    on_base = [link for joint, link in own.items() if link in named and robot.joint_parent(joint) == robot.root_link]
    others = [joint for joint in robot.moving_joint_names if own[joint] not in on_base]
    return on_base if len(on_base) >= 3 and not others else []


def start_posture(robot: RobotDescription) -> dict[str, float]:
    """Moving joints with limits, and where they start [rad]: at zero, or in the middle of a range without it."""
    start = {}
    for name in robot.moving_joint_names:
        joint = robot.joint(name)
        if joint.type != "revolute" or joint.mimic is not None or joint.limit is None:
            continue
        low, high = joint.limit.lower, joint.limit.upper
        if low is not None and high is not None and low < high:
            start[name] = 0.0 if low < 0.0 < high else 0.5 * (low + high)
    return start


def center_of_mass(robot: RobotDescription, poses: Mapping[str, Matrix]) -> Matrix:
    """(3,) of the whole robot in root axes [m]."""
    bodies = [(link, inertial) for link in robot.link_names if (inertial := robot.inertial(link)) is not None]
    moments = [inertial.mass * inertial.moved(poses[link]).com for link, inertial in bodies]
    return np.asarray(np.sum(moments, axis=0) / sum(inertial.mass for _, inertial in bodies))


def arms_around(
    robot: RobotDescription, count: int, motor: Inertial, posture: Mapping[str, float]
) -> tuple[RobotDescription, list[Mount]]:
    """The robot with arms evenly around its center of mass, above its base."""
    poses = robot.frame_poses(posture)
    com = center_of_mass(robot, poses)
    reach = max(np.hypot(*(pose[:2, 3] - com[:2])) for pose in poses.values())
    radius = max(LEAST_RADIUS, reach + BEYOND)
    mounts = []
    for k in range(count):
        azimuth = 2.0 * np.pi * (k + 0.5) / count
        outward = np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
        root_T_arm = _arm_pose(com + HUB_SHARE * radius * outward, outward)
        robot, mount = _with_arm(robot, k, robot.root_link, root_T_arm, (1.0 - HUB_SHARE) * radius, motor)
        mounts.append(mount)
    return robot, mounts


def arms_on(
    robot: RobotDescription, links: Sequence[str], motor: Inertial, posture: Mapping[str, float]
) -> tuple[RobotDescription, list[Mount]]:
    """The robot with an arm on each of the named links, pointing away from its center of mass."""
    poses = robot.frame_poses(posture)
    for link in links:
        robot.link(link)
    com = center_of_mass(robot, poses)
    mounts = []
    for k, link in enumerate(links):
        point = poses[link][:3, 3]
        root_T_arm = _arm_pose(point, _outward(point - com))
        robot, mount = _with_arm(robot, k, link, inverse(poses[link]) @ root_T_arm, LEAST_RADIUS - BEYOND, motor)
        mounts.append(mount)
    return robot, mounts


def arms_to(robot: RobotDescription, jets: Sequence[str]) -> tuple[RobotDescription, list[Mount]]:
    """The robot with an arm to each of the propellers that it has; they hang from the arms then."""
    poses = robot.frame_poses()
    com = center_of_mass(robot, poses)
    carried_by = {robot.joint(joint).child: joint for joint in robot.joint_names}
    mounts = []
    for k, jet in enumerate(jets):
        robot.link(jet)
        if jet not in carried_by:
            raise UrdfError(f"link {jet} is the base of the robot and cannot be a jet")
        joint, pose = carried_by[jet], poses[jet]
        parent = robot.joint_parent(joint)
        outward = _outward(pose[:3, 3] - com)
        distance = float(np.hypot(*(pose[:2, 3] - com[:2])))
        root_T_arm = _arm_pose(pose[:3, 3] - (1.0 - HUB_SHARE) * distance * outward, outward)
        arm = f"jet_arm_{k + 1}"
        robot = robot.with_link(arm, f"{arm}_fixed", parent, inverse(poses[parent]) @ root_T_arm, _placeholder())
        robot = robot.hung_from(joint, arm, inverse(root_T_arm) @ pose)
        rotation = root_T_arm[:3, :3].T @ pose[:3, :3]
        axis = _upward(pose[:3, :3])
        length = (1.0 - HUB_SHARE) * distance
        mounts.append(Mount(arm, jet, joint, length, axis, rotation, float(np.arctan2(outward[1], outward[0]))))
    return robot, mounts


def _with_arm(
    robot: RobotDescription, k: int, parent: str, parent_T_arm: Matrix, length: float, motor: Inertial
) -> tuple[RobotDescription, Mount]:
    arm, jet = f"jet_arm_{k + 1}", f"jet_{k + 1}"
    at_end = np.eye(4)
    at_end[0, 3] = length
    robot = robot.with_link(arm, f"{arm}_fixed", parent, parent_T_arm, _placeholder())
    robot = robot.with_link(jet, f"{jet}_fixed", arm, at_end, motor)
    return robot, Mount(arm, jet, f"{jet}_fixed", length, (0.0, 0.0, 1.0), np.eye(3), 0.0)


def _placeholder() -> Inertial:
    """Of an arm, until a design's arm takes its place."""
    return Inertial(0.05, np.zeros(3), np.eye(3) * 1e-4)


def _outward(offset: Matrix) -> Matrix:
    """Horizontal unit vector along an offset; forward where it has no horizontal share."""
    flat = np.array([offset[0], offset[1], 0.0])
    length = float(np.linalg.norm(flat))
    return flat / length if length > 1e-6 else np.array([1.0, 0.0, 0.0])


def _arm_pose(point: Matrix, outward: Matrix) -> Matrix:
    pose = np.eye(4)
    pose[:3, :3] = np.column_stack([outward, np.cross(UPRIGHT, outward), UPRIGHT])
    pose[:3, 3] = point
    return pose


def _upward(rotation: Matrix) -> tuple[float, float, float]:
    """The axis of a frame, with its sign, that points up most."""
    k = int(np.abs(rotation[2]).argmax())
    axis = np.zeros(3)
    axis[k] = np.sign(rotation[2, k])
    return (float(axis[0]), float(axis[1]), float(axis[2]))


def is_held(robot: RobotDescription, joint: str) -> bool:
    """Whether a joint moves in the URDF but not in the flight: without a range, or not a revolute one."""
    return robot.joint(joint).type in MOVING and joint not in start_posture(robot)
