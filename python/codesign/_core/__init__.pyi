"""
Compiled core of codesign: rigid-body dynamics, flight, finite elements.
"""

from __future__ import annotations
import collections.abc
import typing
from . import dynamics
from . import fem

__all__: list[str] = [
    "DesignResult",
    "PartAnalysis",
    "PartCase",
    "analyse_part",
    "dynamics",
    "evaluate",
    "fem",
    "library_versions",
]

class PartCase:
    """
    One part and its load case; supports and loads name surface faces.
    """
    def __init__(
        self,
        *,
        surface: fem.SurfaceMesh,
        size: fem.SizeField,
        material: fem.Material,
        supports: collections.abc.Sequence[fem.Support],
        loads: collections.abc.Sequence[
            fem.Force | fem.Traction | fem.Pressure | fem.AffineTraction | fem.Acceleration | fem.BodyForce
        ],
        settings: fem.StaticSettings = ...,
        facet_angle_deg: typing.SupportsFloat | typing.SupportsIndex = 25.0,
    ) -> None: ...

class PartAnalysis:
    """
    Mesh, static result and wall-clock times.
    """
    @property
    def mesh(self) -> fem.TetMesh: ...
    @property
    def mesh_seconds(self) -> float: ...
    @property
    def result(self) -> fem.StaticResult: ...
    @property
    def solve_seconds(self) -> float: ...

class DesignResult:
    @property
    def flight(self) -> dynamics.FlightLog: ...
    @property
    def parts(self) -> list[PartAnalysis]:
        """
        PartAnalysis in the order of the cases
        """
    @property
    def seconds(self) -> dict[str, float]:
        """
        wall clock
        """

def analyse_part(part: PartCase) -> PartAnalysis:
    """
    Surface to safety factor. Raises MeshError, SolverError.
    """

def evaluate(parts: collections.abc.Sequence[PartCase], urdf: str, flight: dynamics.FlightSettings) -> DesignResult:
    """
    Meshes and solves every part, loads the robot and flies it: the native half of the chain in one call, without the GIL.
    """

def library_versions() -> dict[str, str]:
    """
    What the module was built with.
    """
