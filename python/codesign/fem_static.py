"""Static analysis: displacement, stress and safety factor of one part under loads."""

from __future__ import annotations

from collections.abc import Sequence

from codesign._core import fem as _core
from codesign._core.fem import StaticResult as StaticResult
from codesign.fem_model import Load, Material, Support, TetMesh, native_loads, native_supports


class StaticSystem:
    """A supported part, factorised once for any number of load cases.

    Args:
        mesh: ten-node tetrahedra.
        material: linear elastic.
        supports: what holds the part.
        exclusion_distance: [m] the peak stress is read farther than this from supported faces and load borders.
        stress_volume: [m³] `stress_50` is the von Mises stress exceeded in this volume of the part.
        copies: 2 if the mesh is one half of a symmetric part: work and stress_volume then count the whole.
        residual_tolerance: largest relative residual accepted.

    Raises:
        SolverError: the supports leave a rigid motion free (the message names it), or the residual is too large.
        MeshError: an element is inverted.
        ValueError: a selection, material or setting that makes no sense.
    """

    def __init__(
        self,
        mesh: TetMesh,
        material: Material,
        supports: Sequence[Support],
        *,
        exclusion_distance: float = 3e-3,
        stress_volume: float = 50e-9,
        copies: int = 1,
        residual_tolerance: float = 1e-9,
    ) -> None:
        settings = _core.StaticSettings()
        settings.exclusion_distance = exclusion_distance
        settings.stress_volume = stress_volume
        settings.copies = copies
        settings.residual_tolerance = residual_tolerance
        self.mesh = mesh
        self._system = _core.StaticSystem(mesh, material, native_supports(mesh, supports), settings)

    def solve(self, loads: Sequence[Load]) -> StaticResult:
        """The response to one load case."""
        return self._system.solve(native_loads(self.mesh, loads))


def solve_static(
    mesh: TetMesh,
    material: Material,
    supports: Sequence[Support],
    loads: Sequence[Load],
    *,
    exclusion_distance: float = 3e-3,
    stress_volume: float = 50e-9,
    copies: int = 1,
    residual_tolerance: float = 1e-9,
) -> StaticResult:
    """Displacement, stress and safety factor of one load case; arguments as in `StaticSystem`."""
    system = StaticSystem(
        mesh,
        material,
        supports,
        exclusion_distance=exclusion_distance,
        stress_volume=stress_volume,
        copies=copies,
        residual_tolerance=residual_tolerance,
    )
    return system.solve(loads)
