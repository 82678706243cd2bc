"""Parts placed in an assembly."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from codesign.geometry.profile import Vector
from codesign.parts.part import Part


@dataclass(frozen=True, slots=True, eq=False)
class Component:
    """A part at root_T_part (4, 4) [m], called `name` there; several components may share a part."""

    name: str
    part: Part
    pose: Vector

    def __post_init__(self) -> None:
        pose = np.array(self.pose, dtype=float)
        if pose.shape != (4, 4) or not np.allclose(pose[:3, :3] @ pose[:3, :3].T, np.eye(3), rtol=0.0, atol=1e-6):
            raise ValueError(f"component {self.name}: the pose must be a (4, 4) rigid motion")
        pose.setflags(write=False)
        object.__setattr__(self, "pose", pose)


def distinct_parts(components: Iterable[Component]) -> list[Part]:
    """The parts of an assembly, each once, in order of first use."""
    return list(dict.fromkeys(component.part for component in components))
