"""Refusal of unusable URDF text before anything is built from it; every message names the element."""

from __future__ import annotations

import math
import re
import xml.etree.ElementTree as ET
from collections.abc import Iterable

from codesign.dynamics import MAX_URDF_BYTES
from codesign.errors import UrdfError

JOINT_TYPES = ("fixed", "revolute", "continuous", "prismatic", "floating", "planar")
NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")  # what every reader accepts: no nan, inf, 1_0, 0,5

# tag -> attribute -> count of numbers it holds; None: one or three
NUMERIC: dict[str, dict[str, tuple[int, ...]]] = {
    "origin": {"xyz": (3,), "rpy": (3,)},
    "axis": {"xyz": (3,)},
    "mass": {"value": (1,)},
    "inertia": {key: (1,) for key in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")},
    "limit": {key: (1,) for key in ("lower", "upper", "effort", "velocity")},
    "box": {"size": (3,)},
    "cylinder": {"radius": (1,), "length": (1,)},
    "sphere": {"radius": (1,)},
    "mesh": {"scale": (1, 3)},
    "color": {"rgba": (4,)},
}
REQUIRED = {
    "mass": ("value",),
    "inertia": ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"),
    "box": ("size",),
    "cylinder": ("radius", "length"),
    "sphere": ("radius",),
    "mesh": ("filename",),
}


class _NoDoctype(ET.TreeBuilder):
    """Refuses document types: URDF has none, and they are what entity bombs are made of."""

    def doctype(self, name: str, _pubid: str | None, _system: str | None) -> None:
        raise UrdfError(f"document type declaration ({name}) is refused: it could expand without bound")


def parse_xml(text: str | bytes) -> ET.Element:
    """Root element `<robot>` of URDF text; comments inside it are kept. Raises: UrdfError."""
    if len(text) > MAX_URDF_BYTES:
        raise UrdfError(f"{len(text)} bytes are more than the {MAX_URDF_BYTES} a robot description may have")
    parser = ET.XMLParser(target=_NoDoctype(insert_comments=True))
    try:
        root = ET.fromstring(text, parser=parser)
    except ET.ParseError as error:
        raise UrdfError(f"not well-formed XML: {error}") from error
    except (UnicodeError, ValueError) as error:
        raise UrdfError(f"not readable text: {error}") from error
    if root.tag != "robot":
        raise UrdfError(f"the root element is <{root.tag}>, not <robot>")
    if not root.get("name"):
        raise UrdfError("<robot> has no name")
    return root


def check_elements(root: ET.Element) -> None:
    """Names, required children and every number of links and joints. Raises: UrdfError."""
    _check_names(root, "link")
    _check_names(root, "joint")
    for element in (*root.findall("link"), *root.findall("joint")):
        _check_numbers(element, f"{element.tag} {element.get('name')}")
    for link in root.findall("link"):
        _check_link(link)
    for joint in root.findall("joint"):
        _check_joint(joint)


def check_tree(root: ET.Element) -> str:
    """Name of the root link, once links and joints are known to be one tree. Raises: UrdfError."""
    names = [str(link.get("name")) for link in root.findall("link")]
    if not names:
        raise UrdfError("the robot has no links")
    parent_of: dict[str, str] = {}
    for joint in root.findall("joint"):
        name, parent, child = (str(joint.get("name")), _end(joint, "parent"), _end(joint, "child"))
        for role, link in (("parent", parent), ("child", child)):
            if link not in names:
                raise UrdfError(f"joint {name}: {role} link {link!r} does not exist")
        if child in parent_of:
            raise UrdfError(f"joint {name}: link {child} has another parent joint already")
        parent_of[child] = parent
    roots = [name for name in names if name not in parent_of]
    if len(roots) > 1:
        raise UrdfError(f"more than one root link: {', '.join(roots[:5])}")
    reached: set[str] = set(roots)
    for name in names:
        path: list[str] = []
        while name not in reached:
            if name in path:
                raise UrdfError(f"links {', '.join(path[path.index(name) :])} form a cycle")
            path.append(name)
            name = parent_of[name]
        reached.update(path)
    return roots[0]


def _check_names(root: ET.Element, tag: str) -> None:
    seen: set[str] = set()
    for element in root.findall(tag):
        name = element.get("name")
        if not name:
            raise UrdfError(f"a <{tag}> has no name")
        if name in seen:
            raise UrdfError(f"{tag} {name} is defined twice")
        seen.add(name)


def _check_numbers(element: ET.Element, owner: str) -> None:
    for child in element.iter():
        if not isinstance(child.tag, str):  # a comment
            continue
        for attribute in REQUIRED.get(child.tag, ()):
            if child.get(attribute) is None:
                raise UrdfError(f"{owner}: <{child.tag}> has no {attribute}")
        for attribute, counts in NUMERIC.get(child.tag, {}).items():
            text = child.get(attribute)
            if text is not None:
                _check_number_text(text, counts, f"{owner}: <{child.tag}> {attribute}={text[:60]!r}")
    for child in element.iter("box"):
        _require_positive(child, "size", owner)
    for child in (*element.iter("cylinder"), *element.iter("sphere")):
        for attribute in REQUIRED[str(child.tag)]:
            _require_positive(child, attribute, owner)


def _check_number_text(text: str, counts: Iterable[int], where: str) -> None:
    words = text.split()
    if len(words) not in counts:
        raise UrdfError(f"{where}: {len(words)} numbers instead of {' or '.join(map(str, counts))}")
    for word in words:
        if not NUMBER.fullmatch(word) or not math.isfinite(float(word)):
            raise UrdfError(f"{where}: {word!r} is not a finite number")


def _require_positive(element: ET.Element, attribute: str, owner: str) -> None:
    text = element.get(attribute, "")
    if not all(float(word) > 0.0 for word in text.split()):
        raise UrdfError(f"{owner}: <{element.tag}> {attribute}={text!r} must be greater than zero")


def _check_link(link: ET.Element) -> None:
    name = link.get("name")
    inertial = link.find("inertial")
    if inertial is not None:
        for tag in ("mass", "inertia"):
            if inertial.find(tag) is None:
                raise UrdfError(f"link {name}: <inertial> has no <{tag}>")
    for shape in (*link.findall("visual"), *link.findall("collision")):
        geometry = shape.find("geometry")
        kinds = [] if geometry is None else [child.tag for child in geometry if isinstance(child.tag, str)]
        if len(kinds) != 1 or kinds[0] not in ("box", "cylinder", "sphere", "mesh"):
            raise UrdfError(f"link {name}: a <{shape.tag}> needs one box, cylinder, sphere or mesh, has {kinds}")


def _check_joint(joint: ET.Element) -> None:
    name, kind = joint.get("name"), joint.get("type")
    if kind not in JOINT_TYPES:
        raise UrdfError(f"joint {name}: type {kind!r} is not one of {', '.join(JOINT_TYPES)}")
    for tag in ("parent", "child"):
        if not _end(joint, tag):
            raise UrdfError(f"joint {name}: no <{tag}> link")
    axis = joint.find("axis")
    if kind in ("revolute", "continuous", "prismatic") and axis is not None:
        components = [float(word) for word in axis.get("xyz", "1 0 0").split()]
        if not any(components):
            raise UrdfError(f"joint {name}: axis of length zero")
    limit = joint.find("limit")
    if kind in ("revolute", "prismatic"):
        if limit is None:
            raise UrdfError(f"joint {name}: a {kind} joint needs a <limit>")
        lower, upper = float(limit.get("lower", 0.0)), float(limit.get("upper", 0.0))
        if lower > upper:
            raise UrdfError(f"joint {name}: lower limit {lower:g} above upper limit {upper:g}")


def _end(joint: ET.Element, tag: str) -> str:
    end = joint.find(tag)
    return "" if end is None else end.get("link", "")
