"""The typed view of a URDF, against yourdfpy's of the same text."""

import io
import random
import xml.etree.ElementTree as ET
from importlib import resources

import numpy as np
import pytest
import yourdfpy

from codesign.robot.description import RobotDescription
from codesign.robot.urdf_xml import normalized

SHIPPED = sorted(resources.files("codesign.studies").glob("*/*.urdf"))


def chain(links: int) -> str:
    """A chain of links whose angles are any, right ones among them."""
    draw = random.Random(1)

    def origin() -> str:
        angles = [draw.choice([0.0, -0.0, np.pi / 2, -np.pi, draw.uniform(-4.0, 4.0)]) for _ in range(3)]
        return f'<origin xyz="{draw.gauss(0, 1)!r} 0 -0.0" rpy="{" ".join(map(repr, map(float, angles)))}"/>'

    inertial = '<mass value="1.5"/><inertia ixx="1" iyy="1.5" izz="2" ixy="0.1" ixz="0.2" iyz="0.3"/>'
    mesh = '<geometry><mesh filename="a.stl" scale="1 2 3"/></geometry><material name="m"/>'
    text = '<robot name="chain"><link name="0"/>'
    for i in range(1, links):
        text += f'<link name="{i}"><inertial>{origin()}{inertial}</inertial><visual>{origin()}{mesh}</visual></link>'
        text += (
            f'<joint name="to {i}" type="revolute">{origin()}<parent link="{i - 1}"/><child link="{i}"/>'
            '<axis xyz="0 0.6 0.8"/><limit effort="2" velocity="3" lower="-1"/><dynamics damping="0.1"/></joint>'
        )
    return text + "</robot>"


@pytest.mark.parametrize("text", [*(path.read_text() for path in SHIPPED), chain(60)])
def test_every_number_is_that_of_yourdfpy_to_the_last_bit(text):
    robot = RobotDescription.from_text(text)
    read = io.BytesIO(ET.tostring(normalized(ET.fromstring(text))))
    reference = yourdfpy.URDF.load(read, build_scene_graph=False, load_meshes=False).robot
    for link in reference.links:
        own = robot.link(link.name)
        same(own.inertial, link.inertial, ("origin", "mass", "inertia"))
        for shapes, others in ((own.visuals, link.visuals), (own.collisions, link.collisions)):
            for shape, other in zip(shapes, others, strict=True):
                same(shape, other, ("name", "origin"))
                for kind, sizes in KINDS.items():
                    same(getattr(shape.geometry, kind), getattr(other.geometry, kind), sizes)
        for shape, other in zip(own.visuals, link.visuals, strict=True):
            same(shape.material, other.material, ("name",))
    for joint in reference.joints:
        own = robot.joint(joint.name)
        same(own, joint, ("type", "parent", "child", "origin", "axis"))
        same(own.limit, joint.limit, ("effort", "velocity", "lower", "upper"))
        same(own.mimic, joint.mimic, ("joint", "multiplier", "offset"))
        if joint.dynamics is not None:
            assert own.dynamics.damping == float(joint.dynamics.damping)


KINDS = {"box": ("size",), "cylinder": ("radius", "length"), "sphere": ("radius",), "mesh": ("filename", "scale")}


def same(own, other, members):
    assert (own is None) == (other is None)
    for member in members if own is not None else ():
        mine, yours = getattr(own, member), getattr(other, member)
        assert (mine is None) == (yours is None), member
        assert isinstance(mine, str | None) or np.asarray(mine, float).tobytes() == np.asarray(yours, float).tobytes()
        assert not isinstance(mine, str) or mine == yours
