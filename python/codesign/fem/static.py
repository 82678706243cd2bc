"""Static analysis: displacement, stress and safety factor of one part under loads."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from codesign._core import fem as _core
from codesign._core.fem import StaticResult as StaticResult
from codesign._core.fem import UnitResponses as UnitResponses
from codesign.fem.loads import Load, RemoteMass, native_loads
from codesign.fem.model import Material, Support, TetMesh, native_supports

Solver = Literal["automatic", "direct", "iterative"]
Exclusion = Literal["local", "published"]
MEMORY_LIMIT = 4e9  # bytes


@dataclass(frozen=True)
class Modes:
    """Undamped free vibration of a part.

    frequency: (k,) Hz, ascending; 0 for rigid motions. shape: (k, n, 3) displacements [m] of modal mass 1 kg.
    """

    frequency: NDArray[np.float64]
    shape: NDArray[np.float64]

    @classmethod
    def of(cls, native: _core.NaturalModes) -> Modes:
        """From the native result."""
        count = len(native.frequency)
        return cls(np.array(native.frequency), np.array(native.shape).T.reshape(count, -1, 3))


@dataclass(frozen=True)
class Buckling:
    """Linear buckling of a part under a load that keeps its direction.

    factor: (k,) of the load, > 0, ascending; fewer than asked for if there are no more up to the limit.
    shape: (k, n, 3), the largest displacement is 1. reversed: lowest factor of the reversed load; inf: none.
    limit: the factor up to which was sought, at most the one that stresses 1 % of the part beyond a quarter of the
    shear modulus.
    """

    factor: NDArray[np.float64]
    shape: NDArray[np.float64]
    reversed: float
    limit: float

    @property
    def lowest(self) -> float:
        """The lowest factor on the load; inf if there is none up to the limit."""
        return float(self.factor[0]) if len(self.factor) else math.inf

    @classmethod
    def of(cls, native: _core.BucklingModes) -> Buckling:
        """From the native result."""
        factor, shape = np.array(native.factor), np.array(native.shape)
        return cls(factor, shape.T.reshape(len(factor), len(shape) // 3, 3), native.reversed, native.limit)


class StaticSystem:
    """A supported part, factorized once for any number of load cases.

    Args:
        mesh: ten-node tetrahedra.
        material: linear elastic.
        supports: what holds the part.
        exclusion: where the peak stress is not read. "local": at borders of clamps within a fifth of the local feature,
            at sharp pocket edges that border a load within 3 mm (a tenth of the extent of a part below 30 mm).
            "published": 3 mm from supported faces and from every border of a load.
        exclusion_distance: [m] instead of the rule's own distances.
        stress_volume: [m³] `stress_50` is the von Mises stress exceeded in this volume of the part.
        copies: 2 if the mesh is one half of a symmetric part: work and stress_volume then count the whole.
        residual_tolerance: largest relative residual accepted.
        solver: "direct" factorizes, "iterative" (conjugate gradients, two-level preconditioner) needs less memory;
            "automatic" takes the factor if it fits into memory_limit and is the faster way for one load case.
        memory_limit: [bytes] for matrices and factors, of modes and buckling too; decides between the solvers.
        eigenvalues: natural or buckling modes that will be asked for: "automatic" leaves them room within memory_limit.
        masses: rigid bodies that faces of the part carry.

    Raises:
        MemoryLimitError: no solver fits into memory_limit; the message says what it needs.
        SolverError: the supports leave a rigid motion free (the message names it), or the residual is too large.
        MeshError: an element is inverted.
        ModelError (a ValueError): supports or loads that select nothing, act on held nodes only or have no effect; an
            exclusion that leaves no place.
        ValueError: a material or setting that makes no sense.
    """

    def __init__(
        self,
        mesh: TetMesh,
        material: Material,
        supports: Sequence[Support],
        *,
        exclusion: Exclusion = "local",
        exclusion_distance: float | None = None,
        stress_volume: float = 50e-9,
        copies: int = 1,
        residual_tolerance: float = 1e-9,
        solver: Solver = "automatic",
        memory_limit: float = MEMORY_LIMIT,
        masses: Sequence[RemoteMass] = (),
        eigenvalues: int = 0,
    ) -> None:
        if solver not in get_args(Solver):
            raise ValueError(f"solver = {solver!r}: must be one of {', '.join(get_args(Solver))}")
        if exclusion not in get_args(Exclusion):
            raise ValueError(f"exclusion = {exclusion!r}: must be one of {', '.join(get_args(Exclusion))}")
        settings = _core.StaticSettings()
        settings.exclusion = getattr(_core.ExclusionRule, exclusion)
        settings.exclusion_distance = exclusion_distance
        settings.stress_volume = stress_volume
        settings.copies = copies
        settings.residual_tolerance = residual_tolerance
        settings.solver = getattr(_core.LinearSolver, solver)
        settings.memory_limit = memory_limit
        settings.eigenvalues = eigenvalues
        self.mesh = mesh
        self._system = _core.StaticSystem(
            mesh, material, native_supports(mesh, supports), settings, [mass.native(mesh) for mass in masses]
        )

    def solve(self, loads: Sequence[Load]) -> StaticResult:
        """The response to one load case."""
        return self._system.solve(native_loads(self.mesh, loads))

    def unit_responses(self, units: Sequence[Sequence[Load]]) -> UnitResponses:
        """The answers to unit loads (each any number of loads), of which a history of loads is a sum at every instant.

        Remote masses are not in them. `peak(history)` finds the largest stress of a history (instants, units),
        `at(factors)` gives one instant.
        Raises: ModelError: a support is moved.
        """
        return self._system.unit_responses([native_loads(self.mesh, loads) for loads in units])

    def natural_frequencies(self, count: int = 6) -> Modes:
        """The lowest modes on the supports, from the same factor if there is one. Raises: ValueError: no density."""
        return Modes.of(self._system.natural_modes(count))

    def buckling_factors(self, loads: Sequence[Load], count: int = 1) -> Buckling:
        """The lowest buckling modes under one load case, from the same factor if there is one."""
        displacement = self._system.displacement(native_loads(self.mesh, loads))
        return Buckling.of(self._system.buckling_modes(displacement, count))


def solve_static(
    mesh: TetMesh,
    material: Material,
    supports: Sequence[Support],
    loads: Sequence[Load],
    *,
    exclusion: Exclusion = "local",
    exclusion_distance: float | None = None,
    stress_volume: float = 50e-9,
    copies: int = 1,
    residual_tolerance: float = 1e-9,
    solver: Solver = "automatic",
    memory_limit: float = MEMORY_LIMIT,
) -> StaticResult:
    """Displacement [m], stress [Pa] and safety factor of one load case; arguments as in `StaticSystem`."""
    system = StaticSystem(
        mesh,
        material,
        supports,
        exclusion=exclusion,
        exclusion_distance=exclusion_distance,
        stress_volume=stress_volume,
        copies=copies,
        residual_tolerance=residual_tolerance,
        solver=solver,
        memory_limit=memory_limit,
    )
    return system.solve(loads)


def natural_frequencies(
    mesh: TetMesh,
    material: Material,
    supports: Sequence[Support],
    count: int = 6,
    *,
    memory_limit: float = MEMORY_LIMIT,
) -> Modes:
    """The lowest modes of a part on its supports, or of a free one (then the rigid motions come first).

    memory_limit [bytes]: as in `StaticSystem`.
    Raises: ValueError: no density, count < 1; MeshError, SolverError, MemoryLimitError.
    """
    return Modes.of(_core.natural_modes(mesh, material, native_supports(mesh, supports), count, memory_limit))


def buckling_factors(
    mesh: TetMesh,
    material: Material,
    supports: Sequence[Support],
    loads: Sequence[Load],
    count: int = 1,
    *,
    memory_limit: float = MEMORY_LIMIT,
) -> Buckling:
    """The lowest buckling modes of a part on its supports under a load; memory_limit [bytes]: as in `StaticSystem`.

    Raises: ValueError: count < 1; MeshError; SolverError: the part is not held, or the eigenvalues do not converge.
    """
    system = StaticSystem(mesh, material, supports, memory_limit=memory_limit, eigenvalues=count)
    return system.buckling_factors(loads, count)
