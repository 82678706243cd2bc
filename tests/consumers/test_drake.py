"""The exported robot in Drake: read without a warning, the bodies of Pinocchio, nothing collides where it flies."""

import numpy as np
import pinocchio as pin
import pytest
from pydrake.math import RigidTransform
from pydrake.multibody import parsing
from pydrake.multibody.plant import AddMultibodyPlantSceneGraph
from pydrake.systems.framework import DiagramBuilder

from exported_robots import ORIGINAL, Exported, export_robot


@pytest.fixture(scope="module", params=ORIGINAL)
def exported(request, tmp_path_factory) -> Exported:
    return export_robot(request.param, ORIGINAL[request.param], tmp_path_factory.mktemp("export") / "robot", 1.0)


def load(path):
    builder = DiagramBuilder()
    plant, scene = AddMultibodyPlantSceneGraph(builder, 0.0)
    parser = parsing.Parser(plant)
    parser.SetStrictParsing()  # a warning is an error
    parser.AddModels(str(path))
    plant.Finalize()
    diagram = builder.Build()
    context = diagram.CreateDefaultContext()
    return plant, scene, plant.GetMyContextFromRoot(context), scene.GetMyContextFromRoot(context)


def place(plant, context, exported, angles):
    plant.SetFreeBodyPose(context, plant.GetBodyByName(exported.robot.root_link), RigidTransform())
    for name, angle in angles.items():
        plant.GetJointByName(name).set_angle(context, angle)


def test_masses_frames_and_gravity_are_those_of_pinocchio(exported):
    plant, _, context, _ = load(exported.folder / "robot.urdf")
    model = pin.buildModelFromUrdf(str(exported.folder / "robot.urdf"), pin.JointModelFreeFlyer())
    data = model.createData()
    assert plant.CalcTotalMass(context) == pytest.approx(pin.computeTotalMass(model), rel=1e-14)
    rng = np.random.default_rng(2)
    for _ in range(5):
        angles = {}
        q = pin.neutral(model)
        for name in exported.joints:
            limit = exported.robot.joint(name).limit
            angles[name] = rng.uniform(limit.lower, limit.upper)
            q[model.joints[model.getJointId(name)].idx_q] = angles[name]
        place(plant, context, exported, angles)
        pin.framesForwardKinematics(model, data, q)
        for link in exported.robot.link_names:
            pose = plant.GetFrameByName(link).CalcPoseInWorld(context).GetAsMatrix4()
            np.testing.assert_allclose(pose, data.oMf[model.getFrameId(link)].homogeneous, atol=1e-12)
        gravity = pin.computeGeneralizedGravity(model, data, q)
        torques = plant.CalcGravityGeneralizedForces(context)
        for name in exported.joints:
            start = plant.GetJointByName(name).velocity_start()
            assert torques[start] == pytest.approx(-gravity[model.joints[model.getJointId(name)].idx_v], abs=1e-9)


def test_nothing_collides_where_the_robot_flies(exported):
    plant, scene, context, geometry = load(exported.folder / "robot.urdf")
    assert scene.model_inspector().num_geometries() > 0
    settings, log = exported.settings, exported.log
    postures = [settings.initial_joints, *log.joint_positions[::25]]
    for posture in postures:
        place(plant, context, exported, dict(zip(settings.joints, posture, strict=True)))
        query = scene.get_query_output_port().Eval(geometry)
        assert query.ComputePointPairPenetration() == []


def test_without_the_filters_shapes_collide(exported):
    plant, scene, context, geometry = load(exported.robot.write(exported.folder / "bare.urdf"))
    place(plant, context, exported, dict(zip(exported.settings.joints, exported.settings.initial_joints, strict=True)))
    overlapping = [pair for pair, reason in exported.ignored.items() if reason == "Default"]
    found = scene.get_query_output_port().Eval(geometry).ComputePointPairPenetration()
    assert bool(found) == bool(overlapping)
