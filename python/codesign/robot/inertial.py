"""Mass, centre of mass and inertia of a rigid body as one value: replaced, moved and mirrored whole."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from codesign.errors import UrdfError
from codesign.transforms import Axis, Matrix, reflection

# Figures in files are rounded; a plate's principal moments meet the triangle inequality with equality.
TRIANGLE_TOLERANCE = 1e-3  # of the largest principal moment


class MassProperties(Protocol):
    """What a part tells about its mass: part axes; inertia (3, 3) about the centre of mass."""

    @property
    def mass(self) -> float: ...  # noqa: D102
    @property
    def com(self) -> Matrix: ...  # noqa: D102
    @property
    def inertia(self) -> Matrix: ...  # noqa: D102


@dataclass(frozen=True, slots=True, eq=False)
class Inertial:
    """mass [kg]; com (3,) [m]; inertia (3, 3) [kg m²] about the centre of mass, in the axes of the same frame."""

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
        """The body given in frame b, in frame a."""
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

        Checked: finite numbers, mass > 0, symmetric and positive definite inertia, and the triangle inequality: the
        largest principal moment is at most the sum of the other two. A mass of zero with a zero tensor is a frame.
        """
        values = np.concatenate([[self.mass], self.com, self.inertia.ravel()])
        if not np.isfinite(values).all():
            raise UrdfError(f"link {name}: mass, centre of mass or inertia is not finite")
        if self.mass < 0.0:
            raise UrdfError(f"link {name}: negative mass {self.mass:g} kg")
        if self.mass == 0.0:
            if self.inertia.any():
                raise UrdfError(f"link {name}: inertia without mass")
            return
        if not np.allclose(self.inertia, self.inertia.T, rtol=1e-9, atol=0.0):
            raise UrdfError(f"link {name}: inertia tensor is not symmetric")
        low, middle, high = np.linalg.eigvalsh(self.inertia)
        moments = f"principal moments {low:.6g}, {middle:.6g}, {high:.6g} kg m²"
        if not low > 0.0:
            raise UrdfError(f"link {name}: inertia tensor is not positive definite ({moments})")
        if low + middle < high * (1.0 - TRIANGLE_TOLERANCE):
            raise UrdfError(f"link {name}: no body has this inertia, one moment exceeds the other two ({moments})")
