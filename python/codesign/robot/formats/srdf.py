"""What MoveIt and Pinocchio want to know beside the URDF: the start posture and the collisions that mean nothing."""

from __future__ import annotations

import xml.etree.ElementTree as ET

from codesign import dynamics as dyn
from codesign.robot.collisions import Pairs
from codesign.robot.description import RobotDescription
from codesign.robot.urdf_xml import number_text

GROUP, START = "flown", "start"


def srdf_text(robot: RobotDescription, settings: dyn.FlightSettings, ignored: Pairs) -> str:
    """SRDF: group "flown" of the flight's joints, its state "start", a floating base, `disable_collisions`.

    Where the base starts is not part of an SRDF.
    """
    root = ET.Element("robot", name=robot.name)
    group = ET.SubElement(root, "group", name=GROUP)
    for name in settings.joints:
        ET.SubElement(group, "joint", name=name)
    state = ET.SubElement(root, "group_state", name=START, group=GROUP)
    for name, angle in zip(settings.joints, settings.initial_joints.tolist(), strict=True):
        ET.SubElement(state, "joint", name=name, value=number_text(angle))
    ET.SubElement(root, "virtual_joint", name="root", type="floating", parent_frame="world", child_link=robot.root_link)
    for (first, second), reason in ignored.items():
        ET.SubElement(root, "disable_collisions", link1=first, link2=second, reason=reason)
    ET.indent(root)
    return '<?xml version="1.0"?>\n' + ET.tostring(root, encoding="unicode") + "\n"
