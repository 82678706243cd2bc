"""Bores with their counterbores, and bosses, as a drawing lists them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from OCP.BRepClass3d import BRepClass3d_SolidClassifier
from OCP.gp import gp_Pnt
from OCP.TopAbs import TopAbs_State

from codesign.geometry.brep import Brep
from codesign.geometry.features import Cylinder, coaxial, cylinders
from codesign.geometry.profile import Vector

BEYOND = 0.02  # mm behind an end of a bore: is there material?
AXES = "XYZ"


@dataclass(frozen=True, eq=False)
class Bore:
    """Cylinders on one axis, all hollow or all solid, from the mouth inwards.

    label: A1, A2 … for bores, B1 … for bosses. axis: unit vector out of the mouth. mouth: (3,) point of the axis at the
    outermost end [mm]. through: open at both ends.
    """

    label: str
    cylinders: tuple[Cylinder, ...]
    axis: Vector
    mouth: Vector
    through: bool

    @property
    def hollow(self) -> bool:
        """A bore, not a boss."""
        return self.cylinders[0].hollow

    @property
    def largest(self) -> float:
        """Largest radius [mm]."""
        return max(cylinder.radius for cylinder in self.cylinders)

    @property
    def depth(self) -> float:
        """From the mouth to the far end [mm]."""
        return max(c.high for c in self.cylinders) - min(c.low for c in self.cylinders)

    @property
    def words(self) -> list[str]:
        """Diameters and lengths, two to a line: `⌀14 × 9 / ⌀8.4 × 6 through`."""
        steps = [f"⌀{_short(2.0 * c.radius)} × {_short(c.length)}" for c in self.cylinders]
        steps[-1] += " through" if self.through else " blind" if self.hollow else " outside"
        return [" / ".join(steps[k : k + 2]) for k in range(0, len(steps), 2)]

    @property
    def direction(self) -> str:
        """The axis, +Z or three numbers."""
        main = int(np.argmax(np.abs(self.axis)))
        if abs(abs(self.axis[main]) - 1.0) < 1e-9:
            return f"{'+' if self.axis[main] > 0 else '-'}{AXES[main]}"
        return " ".join(_short(float(v), 4) for v in self.axis)


def _short(value: float, digits: int = 3) -> str:
    return f"{round(value, digits) + 0.0:.7g}"


def bores(brep: Brep) -> list[Bore]:
    """Bores, each from one mouth inwards, then bosses, each cylinder by itself."""
    found = cylinders(brep)
    holes = coaxial(cylinder for cylinder in found if cylinder.hollow)
    bosses = [[cylinder] for cylinder in found if not cylinder.hollow]
    return [
        _bore(f"{letter}{number}", group, brep)
        for letter, groups in (("A", holes), ("B", bosses))
        for number, group in enumerate(groups, start=1)
    ]


def _bore(label: str, group: list[Cylinder], brep: Brep) -> Bore:
    axis, point = group[0].axis, group[0].point
    low, high = min(c.low for c in group), max(c.high for c in group)
    open_low, open_high = (not _solid(brep, point + at * axis) for at in (low - BEYOND, high + BEYOND))
    wider_low = min(group, key=lambda c: c.low).radius > min(group, key=lambda c: -c.high).radius
    from_high = open_high and not (open_low and wider_low)
    sign, mouth = (1.0, high) if from_high else (-1.0, low)
    ordered = sorted(group, key=lambda c: -c.high if from_high else c.low)
    return Bore(label, tuple(ordered), sign * axis, point + mouth * axis, open_low and open_high)


def _solid(brep: Brep, point: Vector) -> bool:
    classifier = BRepClass3d_SolidClassifier(brep.shape, gp_Pnt(*point.tolist()), 1e-6)
    return bool(classifier.State() == TopAbs_State.TopAbs_IN)
