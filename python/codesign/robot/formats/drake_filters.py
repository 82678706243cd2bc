"""Collisions that mean nothing, as Drake reads them in URDF and SDF files."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Mapping

from codesign.robot.collisions import Pairs

DRAKE = "drake.mit.edu"
NAMESPACE = {"xmlns:drake": DRAKE}
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
    """The same as a URDF has them: names are attributes, the prefix `drake:` is that of `NAMESPACE`."""
    groups = []
    for group in collision_filters(ignored):
        written = ET.Element("drake:collision_filter_group", group.attrib)
        for element in group:
            tag = str(element.tag).rpartition("}")[2]
            ET.SubElement(written, f"drake:{tag}", {"link" if tag == MEMBER else "name": str(element.text)})
        groups.append(written)
    return groups
