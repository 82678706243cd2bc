"""Exported robots as other programs read them: masses, frames, gravity torques in a posture, for comparison."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from codesign.robot.formats.mjcf import GRAVITY
from codesign.transforms import quaternion, rotation_from_quaternion, rotation_from_rpy
from exported_robots import Exported


@dataclass(frozen=True)
class Reading:
    """A robot in a posture: mass [kg], com (3,) [m], inertia (3, 3) about it, link -> (4, 4), joint -> gravity torque.

    World axes. Torques are those that hold the joint against gravity [N m]; none where the reader has no words for
    them. contacts: of its shapes; None: not known.
    """

    mass: float
    com: np.ndarray
    inertia: np.ndarray
    frames: Mapping[str, np.ndarray]
    gravity: Mapping[str, float]
    contacts: int | None = None


Reader = Callable[[np.ndarray, Mapping[str, float]], Reading]  # of base pose (4, 4) and angles of all moving joints


def pinocchio(exported: Exported) -> Reader:
    """The URDF in Pinocchio: what the others are compared with."""
    import pinocchio as pin

    model = pin.buildModelFromUrdf(str(exported.folder / "robot.urdf"), pin.JointModelFreeFlyer())
    data = model.createData()
    joints = {name: model.joints[model.getJointId(name)] for name in exported.joints}

    def read(base, angles):
        q = pin.neutral(model)
        w, x, y, z = quaternion(base[:3, :3])
        q[:7] = [*base[:3, 3], x, y, z, w]
        for name, angle in angles.items():
            q[joints[name].idx_q] = angle
        pin.framesForwardKinematics(model, data, q)
        pin.ccrba(model, data, q, np.zeros(model.nv))
        torques = pin.computeGeneralizedGravity(model, data, q)
        return Reading(
            pin.computeTotalMass(model),
            pin.centerOfMass(model, data, q).copy(),
            data.Ig.inertia.copy(),
            {link: data.oMf[model.getFrameId(link)].homogeneous.copy() for link in exported.robot.link_names},
            {name: torques[joint.idx_v] for name, joint in joints.items()},
        )

    return read


def mujoco(exported: Exported) -> Reader:
    """The MJCF in MuJoCo."""
    import mujoco

    model = mujoco.MjModel.from_xml_path(str(exported.folder / "robot.xml"))
    data = mujoco.MjData(model)

    def inertia():
        total, com = np.zeros((3, 3)), data.subtree_com[1]
        for i in range(1, model.nbody):
            R, r, mass = data.ximat[i].reshape(3, 3), data.xipos[i] - com, model.body_mass[i]
            total += R @ np.diag(model.body_inertia[i]) @ R.T + mass * (r @ r * np.eye(3) - np.outer(r, r))
        return total

    def read(base, angles):
        data.qpos[:7] = [*base[:3, 3], *quaternion(base[:3, :3])]
        for name, angle in angles.items():
            data.joint(name).qpos = angle
        mujoco.mj_forward(model, data)
        frames = {}
        for link in exported.robot.link_names:
            frames[link] = np.eye(4)
            frames[link][:3] = np.column_stack([data.body(link).xmat.reshape(3, 3), data.body(link).xpos])
        return Reading(
            model.body_subtreemass[1],
            data.subtree_com[1].copy(),
            inertia(),
            frames,
            {name: data.joint(name).qfrc_bias[0] for name in angles},
            data.ncon,
        )

    return read


def idyntree(exported: Exported) -> Reader:
    """The URDF in iDynTree."""
    from idyntree import bindings as idyn

    loader = idyn.ModelLoader()
    assert loader.loadModelFromString((exported.folder / "robot.urdf").read_text())
    state = idyn.KinDynComputations()
    assert state.loadRobotModel(loader.model())
    assert state.setFloatingBase(exported.robot.root_link)
    state.setFrameVelocityRepresentation(idyn.MIXED_REPRESENTATION)
    model, n = state.model(), state.getNrOfDegreesOfFreedom()
    offsets = {name: model.getJoint(model.getJointIndex(name)).getDOFsOffset() for name in exported.joints}

    def read(base, angles):
        s = np.zeros(n)
        for name, angle in angles.items():
            s[offsets[name]] = angle
        assert state.setRobotState(base, s, np.zeros(6), np.zeros(n), np.array([0.0, 0.0, -GRAVITY]))
        locked = state.getRobotLockedInertia()
        torques = idyn.FreeFloatingGeneralizedTorques(model)
        assert state.generalizedGravityForces(torques)
        joint_torques = torques.jointTorques().toNumPy()
        return Reading(
            locked.getMass(),
            state.getCenterOfMassPosition().toNumPy().copy(),
            locked.getRotationalInertiaWrtCenterOfMass().toNumPy().copy(),
            {
                link: state.getWorldTransform(link).asHomogeneousTransform().toNumPy().copy()
                for link in exported.robot.link_names
            },
            {name: joint_torques[offsets[name]] for name in angles},
        )

    return read


def drake(exported: Exported, file: str = "robot.urdf") -> Reader:
    """The URDF, SDF or MJCF in Drake. Its parser drops what it does not know of MJCF with warnings."""
    from pydrake.math import RigidTransform
    from pydrake.multibody.parsing import Parser
    from pydrake.multibody.plant import AddMultibodyPlantSceneGraph
    from pydrake.systems.framework import DiagramBuilder

    builder = DiagramBuilder()
    plant, scene = AddMultibodyPlantSceneGraph(builder, 0.0)
    (instance,) = Parser(plant).AddModels(str(exported.folder / file))
    plant.mutable_gravity_field().set_gravity_vector([0.0, 0.0, -GRAVITY])
    plant.Finalize()
    diagram = builder.Build()
    root = diagram.CreateDefaultContext()
    context = plant.GetMyContextFromRoot(root)
    shapes = scene.GetMyContextFromRoot(root)
    bodies = plant.GetBodyIndices(instance)

    def read(base, angles):
        plant.SetFreeBodyPose(context, plant.GetBodyByName(exported.robot.root_link), RigidTransform(base))
        for name, angle in angles.items():
            plant.GetJointByName(name).set_angle(context, angle)
        com = plant.CalcCenterOfMassPositionInWorld(context)
        locked = plant.CalcSpatialInertia(context, plant.world_frame(), bodies)
        torques = -plant.CalcGravityGeneralizedForces(context)
        return Reading(
            plant.CalcTotalMass(context),
            com,
            locked.Shift(com).CalcRotationalInertia().CopyToFullMatrix3(),
            {
                link: plant.GetFrameByName(link).CalcPoseInWorld(context).GetAsMatrix4()
                for link in exported.robot.link_names
            },
            {name: torques[plant.GetJointByName(name).velocity_start()] for name in angles},
            len(scene.get_query_output_port().Eval(shapes).ComputePointPairPenetration()),
        )

    read.diagram = diagram  # it owns the plant
    return read


def newton(exported: Exported, file: str = "robot.urdf") -> Reader:
    """The URDF or MJCF in Newton, on the CPU. Single precision; links without mass stay bodies of their own."""
    import newton as nt
    import warp

    warp.config.quiet = True
    builder = nt.ModelBuilder()
    if file.endswith(".xml"):
        builder.add_mjcf(str(exported.folder / file))
    else:
        builder.add_urdf(str(exported.folder / file), floating=True)
    model = builder.finalize(device="cpu")
    state = model.state()
    bodies, joints = ([label.split("/")[-1] for label in labels] for labels in (model.body_label, model.joint_label))
    starts = dict(zip(joints, model.joint_q_start.numpy(), strict=False))
    mass, center, inertia = (a.numpy().astype(float) for a in (model.body_mass, model.body_com, model.body_inertia))

    def read(base, angles):
        q = model.joint_q.numpy()
        w, x, y, z = quaternion(base[:3, :3])
        q[:7] = [*base[:3, 3], x, y, z, w]
        for name, angle in angles.items():
            q[starts[name]] = angle
        nt.eval_fk(model, warp.array(q, dtype=float, device="cpu"), model.joint_qd, state)
        frames = {}
        for link, pose in zip(bodies, state.body_q.numpy().astype(float), strict=True):
            frames[link] = np.eye(4)
            frames[link][:3, :3] = rotation_from_quaternion([pose[6], *pose[3:6]])
            frames[link][:3, 3] = pose[:3]
        turns = np.array([frames[link][:3, :3] for link in bodies])
        places = np.array([frames[link][:3, 3] for link in bodies]) + np.einsum("nij,nj->ni", turns, center)
        com = mass @ places / mass.sum()
        arms = places - com
        squares = np.einsum("ni,ni->n", arms, arms)[:, None, None] * np.eye(3)
        shifted = mass[:, None, None] * (squares - np.einsum("ni,nj->nij", arms, arms))
        return Reading(mass.sum(), com, (turns @ inertia @ turns.transpose(0, 2, 1) + shifted).sum(0), frames, {})

    return read


def differences(exported: Exported, reader: Reader, postures: int, seed: int = 3) -> dict[str, float]:
    """Largest differences from Pinocchio over random postures and base poses; inertia: of its largest entry."""
    rng, reference, found = np.random.default_rng(seed), pinocchio(exported), {}
    for _ in range(postures):
        base = np.eye(4)
        base[:3, :3], base[:3, 3] = rotation_from_rpy(rng.uniform(-3, 3, 3)), rng.uniform(-2, 2, 3)
        limits = {name: exported.robot.joint(name).limit for name in exported.joints}
        angles = {name: rng.uniform(limit.lower, limit.upper) for name, limit in limits.items()}
        one, other = reference(base, angles), reader(base, angles)
        pairs = {
            "mass": (other.mass, one.mass),
            "com": (other.com, one.com),
            "inertia": (other.inertia / np.abs(one.inertia).max(), one.inertia / np.abs(one.inertia).max()),
            "frames": tuple(np.array([r.frames[link] for link in exported.robot.link_names]) for r in (other, one)),
        }
        if other.gravity:
            pairs["gravity"] = tuple(np.array([r.gravity[name] for name in angles]) for r in (other, one))
        for name, (a, b) in pairs.items():
            found[name] = max(found.get(name, 0.0), float(np.abs(np.subtract(a, b)).max()))
    return found


def contacts_in_flight(exported: Exported, reader: Reader) -> int:
    """Contacts of the robot's shapes with each other, in the flight's start and every 25th sample, all together."""
    postures = [exported.settings.initial_joints, *exported.log.joint_positions[::25]]
    still = dict.fromkeys(exported.joints, 0.0)
    names = exported.settings.joints
    readings = [reader(np.eye(4), still | dict(zip(names, posture, strict=True))) for posture in postures]
    return sum(reading.contacts or 0 for reading in readings)


def usd_differences(exported: Exported, folder: Path) -> dict[str, float]:
    """Largest differences from the URDF of what urdf-usd-converter makes of it, in its posture, all joints at zero.

    inertia: of every link about its center of mass, in its axes, relative to the largest of the link. frames: origins
    [m], turned: axes. The format keeps physics in single precision, and the converter gets angles from the cosine of a
    half: 1 degree is 2.4e-6 rad off.
    """
    from pxr import Usd, UsdGeom, UsdPhysics
    from urdf_usd_converter import Converter

    asset = Converter().convert(str(exported.folder / "robot.urdf"), str(folder))
    stage = Usd.Stage.Open(asset.path)
    prims = {prim.GetName(): prim for prim in stage.Traverse() if prim.IsA(UsdGeom.Xform)}
    cache, poses = UsdGeom.XformCache(), exported.robot.frame_poses()
    origin = np.linalg.inv(np.array(cache.GetLocalToWorldTransform(prims[exported.robot.root_link])).T)
    found = dict.fromkeys(("mass", "com", "inertia", "frames", "turned"), 0.0)
    for link in exported.robot.link_names:
        pose = origin @ np.array(cache.GetLocalToWorldTransform(prims[link])).T
        compared = {"frames": (pose[:3, 3], poses[link][:3, 3]), "turned": (pose[:3, :3], poses[link][:3, :3])}
        inertial = exported.robot.inertial(link)
        if inertial is not None:
            body = UsdPhysics.MassAPI(prims[link])
            turn = body.GetPrincipalAxesAttr().Get()
            R = rotation_from_quaternion([turn.GetReal(), *turn.GetImaginary()])
            tensor = R @ np.diag(body.GetDiagonalInertiaAttr().Get()) @ R.T
            largest = np.abs(inertial.inertia).max() or 1.0
            compared |= {
                "mass": (body.GetMassAttr().Get(), inertial.mass),
                "com": (body.GetCenterOfMassAttr().Get(), inertial.com),
                "inertia": (tensor / largest, inertial.inertia / largest),
            }
        for name, (a, b) in compared.items():
            found[name] = max(found[name], float(np.abs(np.subtract(a, b)).max()))
    return found


READERS: dict[str, tuple[str, Callable[[Exported], Reader]]] = {
    "MuJoCo, `robot.xml`": ("mujoco", mujoco),
    "Drake, `robot.urdf`": ("drake", drake),
    "Drake, `robot.sdf`": ("drake", partial(drake, file="robot.sdf")),
    "Drake, `robot.xml`": ("drake", partial(drake, file="robot.xml")),
    "iDynTree, `robot.urdf`": ("idyntree", idyntree),
    "Newton, `robot.urdf`": ("newton", newton),
    "Newton, `robot.xml`": ("newton", partial(newton, file="robot.xml")),
}  # what reads which file -> package, reader
USD = ("urdf-usd-converter", "USD, `robot.urdf`")
