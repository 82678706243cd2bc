"""URDF text as XML: read as it stands, and put in order for readers that know less than the format allows."""

from __future__ import annotations

import copy
import xml.etree.ElementTree as ET
from collections.abc import Iterator, Mapping, Sequence
from xml.parsers import expat

import numpy as np
from numpy.typing import ArrayLike

from codesign.errors import UrdfError
from codesign.robot.urdf_elements import Joint
from codesign.transforms import rotation_from_quaternion, rotation_from_rpy, rpy_from_rotation

MOVING = ("revolute", "continuous", "prismatic")
_READ = ("link", "joint", "material")
_SIZES = {"box": ("size",), "cylinder": ("radius", "length"), "sphere": ("radius",), "capsule": ("radius",)}


def parsed(content: bytes, encodings: Sequence[str | None]) -> ET.Element:
    """Root element of checked text, with comments, in the first encoding that fits; None: the one that it declares.

    Prefixes stay part of names, declared or not: what other tools put into a file costs no robot.
    """
    for encoding in encodings:
        builder = ET.TreeBuilder(insert_comments=True)
        parser = expat.ParserCreate(encoding)
        parser.buffer_text = True
        parser.StartElementHandler = builder.start
        parser.EndElementHandler = builder.end
        parser.CharacterDataHandler = builder.data
        parser.CommentHandler = builder.comment
        try:
            parser.Parse(content.lstrip(), True)
            return builder.close()
        except expat.ExpatError as error:
            reason = error
    raise UrdfError(f"not readable text: {reason}")


def normalized(xml: ET.Element) -> ET.Element:
    """Links, joints and materials alone, in the words that every reader knows.

    Quaternions become angles, limits without ends get zeros, capsules become a cylinder with two spheres; drawn
    primitives without extent are left out.
    """
    root = ET.Element(xml.tag, name=str(xml.get("name")))
    for element in xml:
        if element.tag in _READ:
            root.append(copy.deepcopy(element))
    for element in root.iter():
        for key in [key for key in element.attrib if ":" in key]:
            del element.attrib[key]
    for origin in root.iter("origin"):
        quaternion = origin.attrib.pop("quat_xyzw", None)
        if quaternion is not None:
            x, y, z, w = (float(number) for number in quaternion.split())
            origin.set("rpy", number_text(rpy_from_rotation(rotation_from_quaternion([w, x, y, z]))))
    for joint in root.iter("joint"):
        limit = joint.find("limit")
        if limit is not None and joint.get("type") in ("revolute", "prismatic"):
            for end in ("lower", "upper"):
                limit.attrib.setdefault(end, "0")
    for link in root.iter("link"):
        shapes = [shape for element in link for shape in _shapes(element)]
        link[:] = shapes
    return root


def without_shapes(xml: ET.Element) -> str:
    """Text of a robot without what it looks like and collides with."""
    bare = ET.Element(xml.tag, xml.attrib)
    for element in xml:
        if element.tag == "link":
            link = ET.SubElement(bare, "link", element.attrib)
            link.extend(child for child in element if child.tag not in ("visual", "collision"))
        elif element.tag != "material":
            bare.append(element)
    return ET.tostring(bare, encoding="unicode")


def _shapes(element: ET.Element) -> Iterator[ET.Element]:
    """What stands for an element of a link."""
    if element.tag not in ("visual", "collision"):
        yield element
        return
    shape = next((item for item in element.iterfind("geometry/*") if item.tag in _SIZES), None)
    if shape is None:
        yield element
        return
    sizes = [float(number) for key in _SIZES[shape.tag] for number in str(shape.get(key)).split()]
    if min(sizes) <= 0.0:
        return
    if shape.tag == "capsule":
        yield from _capsule(element, *(float(str(shape.get(key))) for key in ("radius", "length")))
    else:
        yield element


def _capsule(element: ET.Element, radius: float, length: float) -> Iterator[ET.Element]:
    """A cylinder along z and a sphere on each end of it."""
    given = element.find("origin")
    xyz = np.array([float(number) for number in ("" if given is None else given.get("xyz", "")).split()] or [0.0] * 3)
    rpy = "0 0 0" if given is None else given.get("rpy", "0 0 0")
    axis = rotation_from_rpy([float(number) for number in rpy.split()])[:, 2]
    pieces: list[tuple[str, dict[str, float], float]] = [
        ("sphere", {"radius": radius}, z) for z in (-length / 2, length / 2)
    ]
    if length > 0.0:
        pieces.append(("cylinder", {"radius": radius, "length": length}, 0.0))
    for tag, sizes, z in pieces:
        piece = copy.deepcopy(element)
        for old in piece.findall("origin"):
            piece.remove(old)
        piece.insert(0, ET.Element("origin", xyz=number_text(xyz + z * axis), rpy=rpy))
        geometry = piece.find("geometry")
        assert geometry is not None  # it holds the capsule
        geometry[:] = [ET.Element(tag, {key: number_text(size) for key, size in sizes.items()})]
        yield piece


def resolved_mimics(joints: Mapping[str, Joint]) -> dict[str, tuple[str, float, float]]:
    """Joint that mimics -> the joint that it follows in the end, multiplier, offset.

    joints: name -> joint of a checked robot. Raises: UrdfError for circles and unknown joints.
    """

    def followed(name: str) -> tuple[str, float, float] | None:
        joint = joints[name]
        if joint.mimic is None or joint.type not in MOVING:
            return None
        return joint.mimic.joint, joint.mimic.multiplier, joint.mimic.offset

    resolved = {}
    for name in joints:
        seen, place = {name}, followed(name)
        while place is not None:
            other, multiplier, offset = place
            if other not in joints or other in seen:
                reason = "mimics it in turn" if other in joints else "does not exist"
                raise UrdfError(f"joint {name} mimics joint {other}, which {reason}")
            seen.add(other)
            resolved[name] = place
            following = followed(other)
            if following is None:
                break
            place = (following[0], multiplier * following[1], offset + multiplier * following[2])
    return resolved


def number_text(values: ArrayLike) -> str:
    """Numbers of a URDF attribute (any shape, row by row): shortest text that reads back exactly, no negative zero."""
    return " ".join(repr(float(value) + 0.0) for value in np.asarray(values, dtype=float).ravel())
