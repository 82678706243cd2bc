"""The exported robot in Drake: read without a warning, the bodies of Pinocchio, nothing collides where it flies."""

import pytest
from pydrake.math import RigidTransform
from pydrake.multibody import parsing
from pydrake.multibody.plant import AddMultibodyPlantSceneGraph
from pydrake.systems.framework import DiagramBuilder

from exported_robots import ORIGINAL, Exported, export_robot
from robot_readers import differences, drake


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


@pytest.mark.parametrize("file", ["robot.urdf", "robot.sdf", "robot.xml"])
def test_masses_inertias_frames_and_gravity_are_those_of_pinocchio(exported, file):
    found = differences(exported, drake(exported, file), 5)
    assert {name: value for name, value in found.items() if not value < 1e-12} == {}


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
