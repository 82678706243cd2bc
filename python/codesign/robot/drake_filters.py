"""Collisions that mean nothing, as Drake reads them in URDF and SDF files."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Mapping

from codesign.robot.collisions import Pairs

DRAKE = "drake.mit.edu"
MEMBER, IGNORED = "member", "ignored_collision_filter_group"


def collision_filters(ignored: Pairs, hosts: Mapping[str, str] | None = None) -> list[ET.Element]:
    """Elements `drake:collision_filter_group` in which names are text (SDF); each link of a pair is a group of its own.

    hosts: link -> the link that is written for it; by default itself.
    """
    ET.register_namespace("drake", DRAKE)
    partners: dict[str, list[str]] = {}
    for pair in ignored:
        a, b = (link if hosts is None else hosts[link] for link in pair)
        if a != b and b not in partners.setdefault(a, []):
            partners[a].append(b)
    groups = []
    for link in dict.fromkeys([*partners, *(other for others in partners.values() for other in others)]):
        group = ET.Element(f"{{{DRAKE}}}collision_filter_group", name=f"only_{link}")
        ET.SubElement(group, f"{{{DRAKE}}}{MEMBER}").text = link
        for other in partners.get(link, []):
            ET.SubElement(group, f"{{{DRAKE}}}{IGNORED}").text = f"only_{other}"
        groups.append(group)
    return groups


def urdf_collision_filters(ignored: Pairs) -> list[ET.Element]:
    """The same as a URDF has them, names as attributes."""
    groups = collision_filters(ignored)
    for group in groups:
        for element in group:
            key = "link" if element.tag.endswith(f"}}{MEMBER}") else "name"
            element.set(key, str(element.text))
            element.text = None
    return groups
