"""
Compiled core of codesign: rigid-body dynamics, flight, finite elements.
"""

from __future__ import annotations
import collections.abc
import numpy
import numpy.typing
import typing
from . import dynamics
from . import fem
from . import interrupt

__all__: list[str] = [
    "CaseConvergence",
    "DesignResult",
    "LoadCase",
    "PartAnalysis",
    "PartCase",
    "Stretch",
    "VaryingCase",
    "analyze_part",
    "dynamics",
    "evaluate",
    "fem",
    "forget_meshes",
    "interrupt",
    "library_versions",
    "limit_kept_meshes",
    "linked_libraries",
]

class LoadCase:
    """
    Loads that act together.
    """
    def __init__(
        self,
        name: str,
        loads: collections.abc.Sequence[
            fem.Force
            | fem.Traction
            | fem.Pressure
            | fem.BearingLoad
            | fem.AffineTraction
            | fem.Acceleration
            | fem.BodyForce
        ],
        least_safety_factor: typing.SupportsFloat | typing.SupportsIndex = 1.0,
        antisymmetric: bool = False,
    ) -> None: ...
    @property
    def antisymmetric(self) -> bool: ...
    @property
    def least_safety_factor(self) -> float: ...
    @property
    def loads(
        self,
    ) -> list[
        fem.Force
        | fem.Traction
        | fem.Pressure
        | fem.BearingLoad
        | fem.AffineTraction
        | fem.Acceleration
        | fem.BodyForce
    ]: ...
    @property
    def name(self) -> str: ...

class VaryingCase:
    """
    Unit loads whose factors vary over time.
    """
    def __init__(
        self,
        name: str,
        units: collections.abc.Sequence[
            collections.abc.Sequence[
                fem.Force
                | fem.Traction
                | fem.Pressure
                | fem.BearingLoad
                | fem.AffineTraction
                | fem.Acceleration
                | fem.BodyForce
            ]
        ],
    ) -> None: ...
    @property
    def name(self) -> str: ...
    @property
    def units(
        self,
    ) -> list[
        list[
            fem.Force
            | fem.Traction
            | fem.Pressure
            | fem.BearingLoad
            | fem.AffineTraction
            | fem.Acceleration
            | fem.BodyForce
        ]
    ]: ...

class Stretch:
    """
    Makes a body longer or shorter along a unit direction: what lies at most `start` behind the origin [m] stays, what lies at least `end` behind it moves by `change` [m]. Raises: ValueError (no unit direction, an empty zone, more than two thirds of it lost).
    """
    def __init__(
        self,
        origin: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        direction: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        start: typing.SupportsFloat | typing.SupportsIndex,
        end: typing.SupportsFloat | typing.SupportsIndex,
        change: typing.SupportsFloat | typing.SupportsIndex,
    ) -> None: ...
    @property
    def change(self) -> float:
        """
        m, of the zone's length
        """
    @property
    def direction(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) unit vector
        """
    @property
    def end(self) -> float:
        """
        m along the direction
        """
    @property
    def origin(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) m
        """
    @property
    def start(self) -> float:
        """
        m along the direction
        """

class PartCase:
    """
    One part and its load cases; supports and loads name surface faces.
    """

    size: fem.SizeField
    def __init__(
        self,
        *,
        surface: fem.SurfaceMesh,
        size: fem.SizeField,
        material: fem.Material,
        supports: collections.abc.Sequence[fem.Support],
        cases: collections.abc.Sequence[LoadCase],
        settings: fem.StaticSettings = ...,
        facet_angle_deg: typing.SupportsFloat | typing.SupportsIndex = 25.0,
        tolerance: typing.SupportsFloat | typing.SupportsIndex = 0.05,
        max_refinements: typing.SupportsInt | typing.SupportsIndex = 0,
    ) -> None: ...
    @property
    def buckling(self) -> int:
        """
        buckling factors wanted
        """
    @buckling.setter
    def buckling(self, arg0: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def cases(self) -> list[LoadCase]: ...
    @property
    def masses(self) -> list[fem.RemoteMass]:
        """
        RemoteMass
        """
    @masses.setter
    def masses(self, arg0: collections.abc.Sequence[fem.RemoteMass]) -> None: ...
    @property
    def material(self) -> fem.Material: ...
    @property
    def max_refinements(self) -> int:
        """
        0: one pass
        """
    @max_refinements.setter
    def max_refinements(self, arg0: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def modes(self) -> int:
        """
        natural frequencies wanted
        """
    @modes.setter
    def modes(self, arg0: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def settings(self) -> fem.StaticSettings: ...
    @property
    def stretch(self) -> Stretch | None:
        """
        Stretch, or None: the part is the surface's body stretched; parts that differ by it alone share a mesh and most of its factor
        """
    @stretch.setter
    def stretch(self, arg0: Stretch | None) -> None: ...
    @property
    def supports(self) -> list[fem.Support]: ...
    @property
    def surface(self) -> fem.SurfaceMesh: ...
    @property
    def tolerance(self) -> float:
        """
        relative, of the peak stress
        """
    @tolerance.setter
    def tolerance(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def varying(self) -> list[VaryingCase]:
        """
        VaryingCase
        """
    @varying.setter
    def varying(self, arg0: collections.abc.Sequence[VaryingCase]) -> None: ...

class CaseConvergence:
    """
    How far a case's peak is settled by meshes refined around it.
    """
    @property
    def change(self) -> float:
        """
        of the peak by the last refinement there, relative; the largest since
        """
    @property
    def refined(self) -> bool:
        """
        around its peak, at least once
        """
    @property
    def settled(self) -> bool:
        """
        refined, estimated error and change within the tolerance; or no stress
        """

class PartAnalysis:
    """
    Mesh, static result and wall-clock times.
    """
    @property
    def buckling_factors(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (buckling,) of the load, ascending, of the whole part; inf where there is none
        """
    @property
    def case_names(self) -> list[str]: ...
    @property
    def converged(self) -> bool:
        """
        every case is settled; of one pass: estimated error of the governing one within the tolerance
        """
    @property
    def convergence(self) -> list[CaseConvergence]:
        """
        CaseConvergence of every load case; none if no refinement is allowed
        """
    @property
    def failure(self) -> str:
        """
        of a finer mesh that could not be made or solved; empty if all could
        """
    @property
    def frequencies(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (modes,) Hz, ascending, of the whole part
        """
    @property
    def governing(self) -> int:
        """
        the case of the smallest safety factor over what it asks for
        """
    @property
    def mesh(self) -> fem.TetMesh: ...
    @property
    def mesh_seconds(self) -> float: ...
    @property
    def refinements(self) -> int: ...
    @property
    def responses(self) -> list[fem.UnitResponses]:
        """
        UnitResponses of each varying case
        """
    @property
    def result(self) -> fem.StaticResult:
        """
        of the governing case
        """
    @property
    def results(self) -> list[fem.StaticResult]:
        """
        StaticResult of every load case
        """
    @property
    def size(self) -> fem.SizeField:
        """
        SizeField of the mesh
        """
    @property
    def solve_seconds(self) -> float: ...
    @property
    def stopped(self) -> str:
        """
        why refining ended without convergence; empty otherwise
        """

class DesignResult:
    @property
    def flights(self) -> list[dynamics.FlightLog]:
        """
        FlightLog, one per seed
        """
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

def analyze_part(part: PartCase) -> PartAnalysis:
    """
    Surface to safety factor. Raises MeshError, SolverError.
    """

def evaluate(
    parts: collections.abc.Sequence[PartCase],
    urdf: str,
    flight: dynamics.FlightSettings,
    seeds: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
) -> DesignResult:
    """
    Meshes and solves every part, loads the robot and flies it once for every seed of the disturbances: the native half of the chain in one call, without the GIL.
    """

def forget_meshes() -> bool:
    """
    Frees what is kept of stretched parts; whether there was anything.
    """

def library_versions() -> dict[str, str]:
    """
    What the module was built with.
    """

def limit_kept_meshes(bytes: typing.SupportsFloat | typing.SupportsIndex) -> None:
    """
    What this process may keep of the meshes and factors of stretched parts, 256 MB at first.
    """

def linked_libraries() -> dict[str, str]:
    """
    Versions of the shared libraries that decide digits, as loaded: CHOLMOD, OpenBLAS and its kernel, C library.
    """
