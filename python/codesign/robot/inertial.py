"""Mass, center of mass and inertia of a rigid body as one value: replaced, moved and mirrored whole."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from codesign.dynamics import check_inertia
from codesign.errors import UrdfError
from codesign.transforms import Axis, Matrix, reflection


class MassProperties(Protocol):
    """What a part tells about its mass: part axes; inertia (3, 3) about the center of mass."""

    @property
    def mass(self) -> float: ...  # noqa: D102
    @property
    def com(self) -> Matrix: ...  # noqa: D102
    @property
    def inertia(self) -> Matrix: ...  # noqa: D102


@dataclass(frozen=True, slots=True, eq=False)
class Inertial:
    """mass [kg]; com (3,) [m]; inertia (3, 3) [kg m²] about the center of mass, in the axes of the same frame."""

    mass: float
    com: Matrix
    inertia: Matrix

    def __post_init__(self) -> None:
        for name, shape in (("com", (3,)), ("inertia", (3, 3))):
            value = np.array(getattr(self, name), dtype=float)
            if value.shape != shape:
                raise ValueError(f"{name} has shape {value.shape}, not {shape}")
            value.setflags(write=False)
            object.__setattr__(self, name, value)
        object.__setattr__(self, "mass", float(self.mass))

    @classmethod
    def of(cls, properties: MassProperties) -> Inertial:
        """The same body as an Inertial."""
        return cls(properties.mass, properties.com, properties.inertia)

    def moved(self, a_T_b: ArrayLike) -> Inertial:
        """The body given in frame b, in frame a, by a pose (4, 4)."""
        T = np.asarray(a_T_b, dtype=float)
        R = T[:3, :3]
        inertia = R @ self.inertia @ R.T
        return Inertial(self.mass, R @ self.com + T[:3, 3], 0.5 * (inertia + inertia.T))

    def mirrored(self, axis: Axis) -> Inertial:
        """The mirror image along one axis of the frame."""
        S = reflection(axis)
        return Inertial(self.mass, S @ self.com, S @ self.inertia @ S)

    def require_physical(self, name: str) -> None:
        """Refuses what no body can have. Raises: UrdfError that names the link `name`.

        Checked: finite numbers, a symmetric tensor, and the rule of flights (`dynamics.check_inertia`): no negative
        mass or principal moment, none that exceeds the sum of the other two beyond rounding, none without mass.
        """
        values = np.concatenate([[self.mass], self.com, self.inertia.ravel()])
        if not np.isfinite(values).all():
            raise UrdfError(f"link {name}: mass, center of mass or inertia is not finite")
        if not np.allclose(self.inertia, self.inertia.T, rtol=1e-9, atol=0.0):
            raise UrdfError(f"link {name}: inertia tensor is not symmetric")
        check_inertia(name, self.mass, self.inertia)
