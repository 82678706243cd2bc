"""
Surfaces, tetrahedra and linear elasticity.
"""

from __future__ import annotations
import collections.abc
import numpy
import numpy.typing
import os
import typing

__all__: list[str] = [
    "Acceleration",
    "AffineTraction",
    "BearingLoad",
    "BodyForce",
    "BucklingModes",
    "Disc",
    "ExclusionRule",
    "Force",
    "HistoryPeak",
    "LeftOut",
    "LinearSolver",
    "MAX_QUESTIONS",
    "MassProperties",
    "Material",
    "MeshQuality",
    "MeshReport",
    "NaturalModes",
    "Plane",
    "Pressure",
    "RemoteMass",
    "Selection",
    "SizeField",
    "SizeSource",
    "SmoothPatch",
    "SmoothReport",
    "StaticResult",
    "StaticSettings",
    "StaticSystem",
    "Support",
    "SurfaceMesh",
    "TIME_LIMIT",
    "TetMesh",
    "Traction",
    "UnitResponses",
    "boundary_surface",
    "check_surface",
    "default_size",
    "face_area",
    "label_by_angle",
    "largest_distance",
    "load_surface",
    "load_vector",
    "mass_properties",
    "natural_modes",
    "nearest_triangle",
    "read_stl",
    "selected_nodes",
    "selected_triangles",
    "smooth_patch",
    "smooth_surface",
    "tetrahedralize",
    "triangles_in_box",
    "triangles_near",
    "triangles_with_normal",
]

class SurfaceMesh:
    """
    Triangles that belong to named faces, in meters.

    Args:
        points: (n, 3) m.
        triangles: (m, 3) indices, counter-clockwise seen from outside.
        face: (m,) index into face_names; one unnamed face if absent.
        face_names: names, "" for an unnamed face.

    Raises:
        ValueError: sizes or indices that do not fit; a name given twice.
        MeshError: a coordinate that is not finite.
    """
    def __init__(
        self,
        points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 3]"],
        triangles: typing.Annotated[numpy.typing.ArrayLike, numpy.int32, "[m, 3]"],
        face: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] | None = None,
        face_names: collections.abc.Sequence[str] | None = None,
    ) -> None: ...
    def __repr__(self) -> str: ...
    @property
    def face(self) -> numpy.ndarray:
        """
        (m,) index into face_names
        """
    @property
    def face_names(self) -> list[str]: ...
    @property
    def points(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 3]"]:
        """
        (n, 3) m
        """
    @property
    def triangles(self) -> typing.Annotated[numpy.typing.NDArray[numpy.int32], "[m, 3]"]:
        """
        (m, 3)
        """

class SmoothReport:
    """
    What smooth_surface did.
    """
    @property
    def facets(self) -> int:
        """
        triangles replaced by curved ones
        """
    @property
    def left(self) -> int:
        """
        triangles left as they are lest the surface folds or crosses itself
        """
    @property
    def max_distance(self) -> float:
        """
        m, of a new point from its place on the triangle replaced
        """
    @property
    def reason(self) -> str:
        """
        why the surface is returned unchanged; empty otherwise
        """
    @property
    def volume_change(self) -> float:
        """
        relative
        """

class MassProperties:
    """
    Mass, center of mass and inertia of a solid.
    """
    @property
    def com(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) m, axes of the surface
        """
    @property
    def inertia(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 3]"]:
        """
        (3, 3) kg m² about the center of mass, axes of the surface
        """
    @property
    def mass(self) -> float:
        """
        kg
        """
    @property
    def volume(self) -> float:
        """
        m³
        """

class SizeSource:
    """
    A polyline near which elements are small.

    Args:
        points: (k, 3) m; one row is a point.
        size: edge length within `radius` of the polyline [m].
        growth: increase of the edge length per meter of distance beyond `radius`.
        radius: m.
    """
    def __init__(
        self,
        points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 3]"],
        size: typing.SupportsFloat | typing.SupportsIndex,
        growth: typing.SupportsFloat | typing.SupportsIndex = 0.5,
        radius: typing.SupportsFloat | typing.SupportsIndex = 0.0,
    ) -> None: ...
    @property
    def growth(self) -> float:
        """
        of the edge length per distance
        """
    @property
    def points(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 3]"]:
        """
        (k, 3) m
        """
    @property
    def radius(self) -> float:
        """
        m
        """
    @property
    def size(self) -> float:
        """
        m
        """

class SizeField:
    """
    Edge length wanted at each point.

    min(base, size + growth * max(0, distance - radius)) over all sources; meters.
    """
    def __call__(
        self, points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 3]"]
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Edge length [m] at points (k, 3) m.
        """
    def __init__(
        self, base: typing.SupportsFloat | typing.SupportsIndex, sources: collections.abc.Sequence[SizeSource] = []
    ) -> None: ...
    def scaled(self, factor: typing.SupportsFloat | typing.SupportsIndex) -> SizeField:
        """
        The field with all edge lengths times a positive factor.
        """
    @property
    def base(self) -> float:
        """
        m
        """
    @property
    def smallest(self) -> float:
        """
        m, the smallest edge length anywhere
        """
    @property
    def sources(self) -> list[SizeSource]:
        """
        list of SizeSource
        """

class MeshQuality:
    """
    Shape of the tetrahedra between their corners.
    """
    @property
    def area(self) -> float:
        """
        m²
        """
    @property
    def below_5_degrees(self) -> int:
        """
        elements with a dihedral angle below 5 degrees
        """
    @property
    def max_dihedral_deg(self) -> float:
        """
        degrees
        """
    @property
    def mean_radius_ratio(self) -> float:
        """
        1 if all are regular
        """
    @property
    def min_dihedral_deg(self) -> float:
        """
        degrees
        """
    @property
    def min_radius_ratio(self) -> float:
        """
        3 inscribed / circumscribed radius; 1 regular, 0 flat
        """
    @property
    def volume(self) -> float:
        """
        m³
        """
    @property
    def worst_tet(self) -> int:
        """
        of the smallest dihedral angle
        """

class MeshReport:
    """
    What was done to get a sound mesh.
    """
    @property
    def collapse_distance(self) -> float:
        """
        m, the farthest that a point of the surface moved for that
        """
    @property
    def collapsed(self) -> int:
        """
        short edges of the surface
        """
    @property
    def crumbs(self) -> int:
        """
        elements removed that hung on the mesh by a point or an edge
        """
    @property
    def genus(self) -> list[int]:
        """
        of each closed piece of the surface, and of the solid
        """
    @property
    def peeled(self) -> int:
        """
        flat boundary elements removed
        """
    @property
    def questions(self) -> int:
        """
        of the refinement about the solid and the size: its work, on any machine
        """
    @property
    def refinements(self) -> int:
        """
        rounds of smaller elements that the surface's topology asked for
        """
    @property
    def small_faults(self) -> int:
        """
        places of at most 0.05 mm and 0.0005 of the extent where the boundary touches itself, on ledges that no element follows; the solid has the topology of the surface
        """
    @property
    def surface_distance(self) -> float | None:
        """
        m, largest between boundary and surface, both ways; None if not measured
        """

class TetMesh:
    """
    Ten-node tetrahedra with named boundary faces.

    Args:
        nodes: (n, 3) m.
        tets: (m, 4), which get straight mid-edge nodes, or (m, 10) with mid-edge nodes on edges
            01 12 02 03 13 23. Elements given inside out are turned over.
        faces: name -> (k, 3) boundary sides by their corner nodes.

    Raises:
        MeshError: flat elements, nodes without element, indices out of range, sides that are not on
            the boundary.
    """
    @typing.overload
    def __init__(
        self,
        nodes: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 3]"],
        tets: typing.Annotated[numpy.typing.ArrayLike, numpy.int32, "[m, 10]"],
        faces: collections.abc.Mapping[str, typing.Annotated[numpy.typing.ArrayLike, numpy.int32, "[m, 3]"]] = {},
    ) -> None: ...
    @typing.overload
    def __init__(
        self,
        nodes: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 3]"],
        tets: typing.Annotated[numpy.typing.ArrayLike, numpy.int32, "[m, 4]"],
        faces: collections.abc.Mapping[str, typing.Annotated[numpy.typing.ArrayLike, numpy.int32, "[m, 3]"]] = {},
    ) -> None: ...
    def __repr__(self) -> str: ...
    @property
    def boundary(self) -> typing.Annotated[numpy.typing.NDArray[numpy.int32], "[m, 6]"]:
        """
        (b, 6); mid-edge nodes on 01 12 20
        """
    @property
    def boundary_face(self) -> numpy.ndarray:
        """
        (b,) index into face_names
        """
    @property
    def face_names(self) -> list[str]:
        """
        that boundary_face indexes
        """
    @property
    def nodes(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 3]"]:
        """
        (n, 3) m
        """
    @property
    def quality(self) -> MeshQuality:
        """
        MeshQuality of the elements
        """
    @property
    def report(self) -> MeshReport:
        """
        MeshReport of how it was made
        """
    @property
    def tets(self) -> typing.Annotated[numpy.typing.NDArray[numpy.int32], "[m, 10]"]:
        """
        (m, 10); mid-edge nodes on 01 12 02 03 13 23
        """

class Material:
    """
    Linear elastic, isotropic material.
    """
    def __init__(
        self,
        name: str,
        young_modulus: typing.SupportsFloat | typing.SupportsIndex,
        poisson_ratio: typing.SupportsFloat | typing.SupportsIndex,
        density: typing.SupportsFloat | typing.SupportsIndex = 0.0,
        yield_strength: typing.SupportsFloat | typing.SupportsIndex = 0.0,
    ) -> None: ...
    def __repr__(self) -> str: ...
    @property
    def density(self) -> float:
        """
        kg/m3
        """
    @property
    def name(self) -> str:
        """
        for people
        """
    @property
    def poisson_ratio(self) -> float:
        """
        -1 to 0.5
        """
    @property
    def yield_strength(self) -> float:
        """
        Pa
        """
    @property
    def young_modulus(self) -> float:
        """
        Pa
        """

class Selection:
    def __init__(
        self,
        faces: collections.abc.Sequence[str] = [],
        triangles: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] = [],
        nodes: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] = [],
    ) -> None: ...
    @property
    def faces(self) -> list[str]: ...
    @property
    def nodes(self) -> list[int]: ...
    @property
    def triangles(self) -> list[int]: ...

class SmoothPatch:
    """
    A piece of one smooth face of a surface.
    """
    @property
    def triangles(self) -> list[int]:
        """
        sorted
        """
    @property
    def type(self) -> str:
        """
        plane, cylinder, cone, sphere or free
        """

class Support:
    def __init__(
        self,
        where: Selection,
        fixed: typing.Annotated[collections.abc.Sequence[bool], "FixedSize(3)"] = [True, True, True],
        displacement: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 3]"] = ...,
        symmetry: bool = False,
    ) -> None: ...
    @property
    def fixed(self) -> typing.Annotated[list[bool], "FixedSize(3)"]: ...
    @property
    def symmetry(self) -> bool: ...
    @property
    def where(self) -> Selection: ...

class Disc:
    def __init__(
        self,
        center: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        axis: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        radius: typing.SupportsFloat | typing.SupportsIndex,
    ) -> None: ...

class Plane:
    def __init__(
        self,
        point: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        normal: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
    ) -> None: ...

class Force:
    def __init__(
        self, where: Selection, force: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]
    ) -> None: ...
    @property
    def force(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        N
        """
    @property
    def where(self) -> Selection: ...

class Traction:
    def __init__(
        self, where: Selection, traction: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]
    ) -> None: ...
    @property
    def traction(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        Pa
        """
    @property
    def where(self) -> Selection: ...

class Pressure:
    def __init__(self, where: Selection, pressure: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def pressure(self) -> float:
        """
        Pa
        """
    @property
    def where(self) -> Selection: ...

class BearingLoad:
    def __init__(
        self, where: Selection, force: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]
    ) -> None: ...
    @property
    def force(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        N
        """
    @property
    def where(self) -> Selection: ...

class AffineTraction:
    def __init__(
        self,
        where: Selection,
        force: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        point: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        moment: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        region: Disc | None,
        mirror: Plane | None,
    ) -> None: ...
    @property
    def force(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        N
        """
    @property
    def mirror(self) -> Plane | None: ...
    @property
    def moment(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        N m
        """
    @property
    def point(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        m
        """
    @property
    def region(self) -> Disc | None: ...
    @property
    def where(self) -> Selection: ...

class Acceleration:
    def __init__(
        self,
        acceleration: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        gradient: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 3]"],
        point: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
    ) -> None: ...
    @property
    def acceleration(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        m/s²
        """
    @property
    def gradient(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 3]"]:
        """
        1/s²
        """
    @property
    def point(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        m
        """

class BodyForce:
    def __init__(self, force: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 3]"]) -> None: ...
    @property
    def force(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 3]"]:
        """
        N/m³
        """

class RemoteMass:
    """
    A rigid body that is carried by faces of a part.
    """
    def __init__(
        self,
        where: Selection,
        mass: typing.SupportsFloat | typing.SupportsIndex,
        position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        inertia: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 3]"],
        region: Disc | None = None,
        mirror: Plane | None = None,
    ) -> None: ...
    @property
    def mass(self) -> float: ...
    @property
    def position(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]: ...

class LinearSolver:
    """
    Members:

      automatic

      direct

      iterative
    """

    __members__: typing.ClassVar[dict[str, LinearSolver]]
    automatic: typing.ClassVar[LinearSolver]
    direct: typing.ClassVar[LinearSolver]
    iterative: typing.ClassVar[LinearSolver]
    @typing.overload
    def __eq__(self, other: LinearSolver) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: LinearSolver) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class ExclusionRule:
    """
    Members:

      local

      published
    """

    __members__: typing.ClassVar[dict[str, ExclusionRule]]
    local: typing.ClassVar[ExclusionRule]
    published: typing.ClassVar[ExclusionRule]
    @typing.overload
    def __eq__(self, other: ExclusionRule) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: ExclusionRule) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class LeftOut:
    """
    Largest von Mises stress that the exclusion leaves out.
    """
    @property
    def border_distance(self) -> float:
        """
        m, from the nearest border of a clamp or load
        """
    @property
    def position(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3) m
        """
    @property
    def stress(self) -> float:
        """
        Pa; 0: nothing is left out
        """

class StaticSettings:
    exclusion: ExclusionRule
    solver: LinearSolver
    def __init__(self) -> None: ...
    @property
    def copies(self) -> int: ...
    @copies.setter
    def copies(self, arg0: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def eigenvalues(self) -> int:
        """
        modes that will be asked for: the automatic choice leaves them room
        """
    @eigenvalues.setter
    def eigenvalues(self, arg0: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def exclusion_distance(self) -> float | None:
        """
        m, everywhere; None: that of the rule
        """
    @exclusion_distance.setter
    def exclusion_distance(self, arg0: typing.SupportsFloat | typing.SupportsIndex | None) -> None: ...
    @property
    def memory_limit(self) -> float:
        """
        bytes for matrices and factors
        """
    @memory_limit.setter
    def memory_limit(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def residual_tolerance(self) -> float: ...
    @residual_tolerance.setter
    def residual_tolerance(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def stress_volume(self) -> float: ...
    @stress_volume.setter
    def stress_volume(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class StaticResult:
    """
    Displacement, stress and safety factor of a part.
    """
    @property
    def border_distance(self) -> float:
        """
        m, of peak_position from the nearest border of a clamp or load
        """
    @property
    def counts_for_peak(self) -> typing.Annotated[numpy.typing.NDArray[numpy.bool], "[m, 1]"]:
        """
        (n) False where the peak stress is not read
        """
    @property
    def displacement(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 3]"]:
        """
        (n, 3) m
        """
    @property
    def element_error(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (m) Pa, difference of element and recovered stress
        """
    @property
    def energy_error(self) -> float:
        """
        estimated relative error in the energy norm
        """
    @property
    def equations(self) -> int:
        """
        free components of displacement
        """
    @property
    def exclusion_largest(self) -> float:
        """
        m
        """
    @property
    def exclusion_smallest(self) -> float:
        """
        m, of the distances kept from borders
        """
    @property
    def iterations(self) -> int:
        """
        of conjugate gradients; 0: solved by the factor
        """
    @property
    def left_out(self) -> LeftOut:
        """
        LeftOut
        """
    @property
    def max_displacement(self) -> float:
        """
        m
        """
    @property
    def peak_at_exclusion(self) -> bool:
        """
        True if the peak lies right beside larger stresses that the exclusion leaves out
        """
    @property
    def peak_position(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3) m
        """
    @property
    def peak_resolved(self) -> bool:
        """
        False if the estimated error exceeds half of the peak stress
        """
    @property
    def peak_stress(self) -> float:
        """
        Pa
        """
    @property
    def reactions(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 3]"]:
        """
        (n, 3) N, supports on the part
        """
    @property
    def residual(self) -> float:
        """
        relative, over the free components
        """
    @property
    def safety_factor(self) -> float:
        """
        yield strength over peak_stress; inf if nothing is stressed
        """
    @property
    def strain_energy(self) -> float:
        """
        J
        """
    @property
    def stress(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 6]"]:
        """
        (n, 6) Pa: xx yy zz xy yz zx
        """
    @property
    def stress_50(self) -> float:
        """
        Pa
        """
    @property
    def stress_error(self) -> float:
        """
        Pa, estimated error of peak_stress
        """
    @property
    def support_forces(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 3]"]:
        """
        (supports, 3) N
        """
    @property
    def von_mises(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n) Pa
        """
    @property
    def work(self) -> float:
        """
        J, load times displacement
        """

class NaturalModes:
    """
    Free vibration of a part.
    """
    @property
    def frequency(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (k,) Hz, ascending; 0 for rigid motions
        """
    @property
    def shape(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (3 n, k) columns, modal mass 1 kg
        """

class BucklingModes:
    """
    Linear buckling of a part under a load.
    """
    @property
    def factor(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (k,) of the load, > 0, ascending
        """
    @property
    def limit(self) -> float:
        """
        factor up to which was sought
        """
    @property
    def reversed(self) -> float:
        """
        lowest factor of the load reversed; inf: none
        """
    @property
    def shape(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (3 n, k) columns, the largest node moves 1
        """

class HistoryPeak:
    """
    Largest von Mises stress over a history of loads.
    """
    @property
    def instant(self) -> int:
        """
        row of the history
        """
    @property
    def pairs(self) -> int:
        """
        of a face or element and a block of instants
        """
    @property
    def position(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3) m
        """
    @property
    def stress(self) -> float:
        """
        Pa
        """
    @property
    def visited(self) -> int:
        """
        pairs that no bound ruled out
        """

class UnitResponses:
    """
    Answers of a part to unit loads.
    """
    def at(self, factors: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> StaticResult:
        """
        StaticResult of one instant, factors (units,).
        """
    def peak(self, history: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"]) -> HistoryPeak:
        """
        Largest von Mises stress over a history (instants, units) of the units' factors.
        """
    @property
    def mesh(self) -> TetMesh:
        """
        TetMesh
        """
    @property
    def stress(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (n, 6 units) Pa at the nodes: xx yy zz xy yz zx of each unit load
        """
    @property
    def units(self) -> int:
        """
        how many unit loads
        """

class StaticSystem:
    """
    A model factorized once for many load cases.
    """
    def __init__(
        self,
        mesh: TetMesh,
        material: Material,
        supports: collections.abc.Sequence[Support],
        settings: StaticSettings,
        masses: collections.abc.Sequence[RemoteMass] = [],
    ) -> None: ...
    def buckling_modes(
        self,
        displacement: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 3]"],
        count: typing.SupportsInt | typing.SupportsIndex,
    ) -> BucklingModes: ...
    def displacement(
        self,
        loads: collections.abc.Sequence[
            Force | Traction | Pressure | BearingLoad | AffineTraction | Acceleration | BodyForce
        ],
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 3]"]:
        """
        (n, 3) m, of one load case
        """
    def natural_modes(self, count: typing.SupportsInt | typing.SupportsIndex) -> NaturalModes: ...
    def solve(
        self,
        loads: collections.abc.Sequence[
            Force | Traction | Pressure | BearingLoad | AffineTraction | Acceleration | BodyForce
        ],
    ) -> StaticResult: ...
    def unit_responses(
        self,
        units: collections.abc.Sequence[
            collections.abc.Sequence[
                Force | Traction | Pressure | BearingLoad | AffineTraction | Acceleration | BodyForce
            ]
        ],
    ) -> UnitResponses: ...

def boundary_surface(mesh: TetMesh) -> SurfaceMesh:
    """
    The boundary of a TetMesh as a SurfaceMesh of flat triangles.
    """

def check_surface(surface: SurfaceMesh) -> None:
    """
    Checks that a surface bounds one solid, with or without cavities.

    Raises:
        MeshError: open, inside-out, not manifold, crossing itself, several bodies; the message says
            what, where and why.
    """

def default_size(
    surface: SurfaceMesh, edge_length: typing.SupportsFloat | typing.SupportsIndex | None = None
) -> SizeField:
    """
    Edge length that follows the local wall thickness.

    Where walls or gaps between walls are thin, 0.85 of their thickness; elsewhere `edge_length`; graded
    between. Never below a twentieth of `edge_length`, nor so small that more than about 250 000
    elements would be needed.

    Args:
        surface: closed, outward-oriented.
        edge_length: m, in thick places; from the mean wall thickness and at most about 30 000 elements
            if absent.

    Raises:
        MeshError: the surface bounds no solid.
        ValueError: edge_length is not positive.
    """

def face_area(mesh: TetMesh, triangles: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex]) -> float:
    """
    Area of curved boundary faces, m2.
    """

def label_by_angle(
    surface: SurfaceMesh, feature_angle_deg: typing.SupportsFloat | typing.SupportsIndex = 40.0
) -> SurfaceMesh:
    """
    The surface with one unnamed face for each piece bounded by edges sharper than the angle.
    """

def largest_distance(surface: SurfaceMesh, other: SurfaceMesh) -> float:
    """
    Largest distance of a point of one surface from the triangles of another. [m]
    """

def load_surface(
    path: os.PathLike | str | bytes,
    scale: typing.SupportsFloat | typing.SupportsIndex = 1.0,
    *,
    feature_angle_deg: typing.SupportsFloat | typing.SupportsIndex = 40.0,
) -> SurfaceMesh:
    """
    Closed surface of an STL file, binary or ASCII, in meters.

    Args:
        path: the file.
        scale: meters per unit of the file; 1e-3 for millimeters.
        feature_angle_deg: edges sharper than this bound the (unnamed) faces.

    Raises:
        MeshError: unreadable, truncated, not finite, empty, huge, open, inside-out, not manifold,
            self-intersecting; the message says what, where and why.
    """

def load_vector(
    mesh: TetMesh,
    material: Material,
    loads: collections.abc.Sequence[
        Force | Traction | Pressure | BearingLoad | AffineTraction | Acceleration | BodyForce
    ],
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]: ...
def mass_properties(surface: SurfaceMesh, density: typing.SupportsFloat | typing.SupportsIndex) -> MassProperties:
    """
    Mass, center of mass and inertia of the polyhedron inside a closed surface.

    Args:
        surface: closed and outward-oriented.
        density: kg/m³, positive.

    Raises:
        MeshError: the surface bounds no solid.
        ValueError: density is not positive.
    """

def natural_modes(
    mesh: TetMesh,
    material: Material,
    supports: collections.abc.Sequence[Support],
    count: typing.SupportsInt | typing.SupportsIndex,
    memory_limit: typing.SupportsFloat | typing.SupportsIndex = 4000000000.0,
    masses: collections.abc.Sequence[RemoteMass] = [],
) -> NaturalModes: ...
def nearest_triangle(
    surface: SurfaceMesh, point: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]
) -> int:
    """
    Index of the triangle of a SurfaceMesh nearest to a point, m.
    """

def read_stl(path: os.PathLike | str | bytes, scale: typing.SupportsFloat | typing.SupportsIndex = 1.0) -> SurfaceMesh:
    """
    The triangles of an STL file as they are, in meters, under one unnamed face: not checked.

    Raises:
        MeshError: unreadable, truncated, another format, not finite, empty, huge.
    """

def selected_nodes(mesh: TetMesh, selection: Selection) -> list[int]:
    """
    Nodes that a selection holds, those of its faces included, sorted.
    """

def selected_triangles(mesh: TetMesh, selection: Selection) -> list[int]:
    """
    Rows of mesh.boundary that a selection holds, sorted.
    """

def smooth_patch(
    surface: SurfaceMesh,
    start: typing.SupportsInt | typing.SupportsIndex,
    max_bend: typing.SupportsFloat | typing.SupportsIndex,
) -> SmoothPatch:
    """
    The plane, cylinder, cone, sphere or free face that a triangle of a SurfaceMesh belongs to.
    """

def smooth_surface(
    surface: SurfaceMesh, feature_angle_deg: typing.SupportsFloat | typing.SupportsIndex = 40.0
) -> tuple[SurfaceMesh, SmoothReport]:
    """
    The smooth surface that a coarse tessellation was made from, in finer triangles.

    The points of a CAD tessellation lie on the true surface: facets that meet at less than the feature
    angle and belong to an arc are curved back, sharp edges between them and the outlines of flat faces
    become round. Flat faces keep their plane, all points stay, each piece has the face of its triangle.

    Args:
        surface: closed, outward-oriented.
        feature_angle_deg: edges sharper than this are edges of the solid; between 0 and 90.

    Returns:
        The surface, and a SmoothReport; the surface as given if nothing is curved, or if it would cross
        itself (`report.reason`).

    Raises:
        MeshError: the surface bounds no solid.
        ValueError: the angle is out of range.

    Source: Vlachos et al., Curved PN Triangles, I3D 2001, with normals fitted to the chords.
    """

def tetrahedralize(
    surface: SurfaceMesh,
    edge_length: typing.SupportsFloat | typing.SupportsIndex | SizeField | None = None,
    *,
    feature_angle_deg: typing.SupportsFloat | typing.SupportsIndex = 40.0,
    simplify: typing.SupportsFloat | typing.SupportsIndex = 5e-05,
    facet_distance: typing.SupportsFloat | typing.SupportsIndex = 0.06,
    facet_angle_deg: typing.SupportsFloat | typing.SupportsIndex = 25.0,
    radius_edge: typing.SupportsFloat | typing.SupportsIndex = 2.5,
    sliver_angle_deg: typing.SupportsFloat | typing.SupportsIndex = 12.0,
    flat_angle_deg: typing.SupportsFloat | typing.SupportsIndex = 6.0,
    curved: bool = True,
    time_limit: typing.SupportsFloat | typing.SupportsIndex = 300.0,
    max_questions: typing.SupportsInt | typing.SupportsIndex = 25000000,
    max_vertices: typing.SupportsInt | typing.SupportsIndex = 400000,
    check_intersections: bool = True,
) -> TetMesh:
    """
    Ten-node tetrahedra of the solid inside a closed surface.

    Sharp edges and borders between different faces become lines of the mesh, and each boundary side
    carries the face of the surface it lies on. The same input gives the same mesh.

    Args:
        surface: closed, outward-oriented, one solid.
        edge_length: m, or a SizeField; default_size(surface) if absent. Elements become smaller
            where the boundary would otherwise have another topology than the surface.
        feature_angle_deg: edges sharper than this are kept.
        simplify: points of the surface may move this far [m] to get rid of tiny edges and ledges;
            never more than 0.0005 of its extent and 0.1 of the smallest edge length.
        facet_distance: of boundary sides to the surface, relative to the edge length.
        facet_angle_deg: smallest angle of a boundary side, at most 30.
        radius_edge: largest circumradius over shortest edge, at least 2.
        sliver_angle_deg: elements with a smaller dihedral angle are improved where possible.
        flat_angle_deg: flatter boundary elements on one face are removed.
        curved: mid-edge nodes of the boundary on the surface instead of on straight edges.
        time_limit: processor seconds; a safety net, the next two decide on every machine alike.
        max_questions: of the refinement about the solid and the size (`report.questions`).
        max_vertices: of corner nodes.
        check_intersections: look for triangles that cross each other first.

    Raises:
        MeshError: the surface bounds no solid or crosses itself; the mesh is empty, in pieces, of
            another topology or wrong volume.
        MeshLimitError: a limit was reached; the message says which and, if points crowd, where.
        ValueError: an option out of range.
    """

def triangles_in_box(
    mesh: TetMesh,
    lower: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
    upper: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
) -> list[int]: ...
def triangles_near(
    mesh: TetMesh,
    point: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
    max_bend: typing.SupportsFloat | typing.SupportsIndex,
) -> list[int]: ...
def triangles_with_normal(
    mesh: TetMesh,
    normal: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
    angle: typing.SupportsFloat | typing.SupportsIndex,
) -> list[int]: ...

MAX_QUESTIONS: int = 25000000
TIME_LIMIT: float = 300.0
