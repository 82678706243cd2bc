"""Stress of a part: from its shape, supports and loads to one native case, and from the native result to numbers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from codesign import _core, fem
from codesign.errors import ModelError, StudyError
from codesign.fem.loads import native_loads
from codesign.fem.model import native_supports
from codesign.fem.static import Exclusion
from codesign.names import nearest
from codesign.units import MEBIBYTE

if TYPE_CHECKING:
    from codesign.parts.part import Part


Vector = NDArray[np.float64]

EDGE_SHARE, FINE_EDGE_SHARE = 0.35, 0.2  # of the mean wall thickness
MOST_ELEMENTS = 60_000  # about, that the mean wall thickness alone may ask for
MAX_REFINEMENTS = 3  # halvings of the edge length around the peak
FLAT, ALONG_AXIS = 1e-3, 1e-3  # of the normals' second moments, of a force: what counts as none, as in cpp/fem/boundary
LEAST_MEAN_NORMAL = 0.1  # length of a face's mean unit normal: 1 for a plane, 0.64 for a half bore, 0 for a whole one


@dataclass(frozen=True, slots=True)
class PressedFace:
    """A total force [N] that presses on a named face, uniformly over its area, against its outward normal."""

    face: str
    force: float

    def along(self, direction: ArrayLike) -> Vector:
        """(3,) the force [N] on a face that is pressed in a (unit) direction, part axes."""
        return self.force * np.asarray(direction, dtype=float)


@dataclass(frozen=True, slots=True)
class PushedFace:
    """A total force (3,) [N] in part axes on a named face, uniformly over its area."""

    face: str
    force: tuple[float, float, float]

    def along(self, direction: ArrayLike) -> Vector:  # noqa: ARG002 (this load has its own)
        """(3,) the force [N], part axes."""
        return np.asarray(self.force, dtype=float)


@dataclass(frozen=True, slots=True)
class InterfaceForce:
    """A force [N] on a face, acting at a point [m], and a moment [N m] about it, all in the axes of an interface."""

    face: str
    interface: str
    force: tuple[float, float, float]
    point: tuple[float, float, float] = (0.0, 0.0, 0.0)
    moment: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def placed(self, part_T_interface: Vector) -> fem.AffineTraction:
        """The same load in part axes, of a pose (4, 4) [m]."""
        R, position = part_T_interface[:3, :3], part_T_interface[:3, 3]
        return fem.AffineTraction(self.face, R @ self.force, R @ self.point + position, R @ self.moment)


@dataclass(frozen=True, slots=True)
class CarriedMass:
    """A rigid body on a face: mass [kg], center of mass [m], principal moments of inertia about it [kg m²].

    In the axes of an interface, or of the part if none is named.
    """

    face: str
    mass: float
    position: tuple[float, float, float]
    moments: tuple[float, float, float] = (0.0, 0.0, 0.0)
    interface: str = ""

    def placed(self, part_T_axes: Vector) -> fem.RemoteMass:
        """The same body in part axes, of a pose (4, 4) [m]."""
        R, origin = part_T_axes[:3, :3], part_T_axes[:3, 3]
        return fem.RemoteMass(self.face, self.mass, R @ self.position + origin, R @ np.diag(self.moments) @ R.T)


PartLoad = PressedFace | PushedFace | InterfaceForce | fem.Load


@dataclass(frozen=True, slots=True)
class CaseSettings:
    """Loads of a part that act together. safety_factor_min: what they ask for, None: what the study asks for."""

    name: str
    loads: tuple[PartLoad, ...]
    safety_factor_min: float | None = None


@dataclass(frozen=True, slots=True)
class FlownCase:
    """A load case whose loads are those of the flight. seats: (interface, face) that what hangs on it pushes on.

    points: where each interface is, part axes [m]; `part_case` fills them in.
    """

    name: str
    seats: tuple[tuple[str, str], ...]
    safety_factor_min: float | None = None
    points: tuple[tuple[float, ...], ...] = ()


@dataclass(frozen=True, slots=True)
class StressSettings:
    """How a part's stress is computed; the same for all parts of a study but for supports and load cases.

    flown: cases whose loads a flight gives, besides at least one of `cases`. masses: what faces carry; accelerations of
    `cases` pull at them, flown loads have theirs from the flight.
    geometry: "simplified" or "full" (see the part). load, support: variant names that a part may offer.
    accuracy: "optimization" or "fine" mesh; "converged": the fine one, refined around the peak until its estimated
    error and its change are within the tolerance. exclusion, exclusion_distance [m]: where the peak stress is not read,
    as in `fem.StaticSystem`. edge_length: [m] of the elements of a part without its own size field; None: from its mean
    wall thickness, about MOST_ELEMENTS at the most; "fine" ones are shorter in proportion. tolerance: wanted relative
    error of the peak stress. modes, buckling: how many natural frequencies and buckling factors are wanted.
    memory_limit: [bytes] for the matrices and factors of one analysis; it decides between factor and iteration.
    """

    material: fem.Material
    supports: Sequence[str]
    cases: Sequence[CaseSettings]
    geometry: Literal["simplified", "full"] = "simplified"
    load: str = "uniform"
    support: str = "published"
    accuracy: Literal["optimization", "fine", "converged"] = "optimization"
    exclusion: Exclusion = "local"
    exclusion_distance: float | None = None
    edge_length: float | None = None
    tolerance: float = 0.05
    memory_limit: float = 1400 * MEBIBYTE
    modes: int = 0
    buckling: int = 0
    flown: Sequence[FlownCase] = ()
    masses: Sequence[CarriedMass | fem.RemoteMass] = ()

    @property
    def segments(self) -> int:
        """Chords on a full circle of the surface that is meshed; fine meshes would find the edges of coarse ones."""
        return 48 if self.accuracy == "optimization" else 128


def part_case(part: Part, settings: StressSettings) -> _core.PartCase:
    """The native case of a part: its own `stress_case` if it has one, else named faces on a uniform mesh.

    Raises: StudyError: a load names an interface that the part does not have.
    """
    settings = placed(part, settings)
    own = getattr(part, "stress_case", None)
    return own(settings) if own is not None else default_case(part, settings)


def placed(part: Part, settings: StressSettings) -> StressSettings:
    """Settings whose forces at interfaces are given in part axes, and whose seats have their place."""
    interfaces = part.interfaces()

    def frame(name: str) -> Vector:
        if name not in interfaces:
            raise StudyError(f"{part.name}: no interface {name!r}; {nearest(name, interfaces)}")
        return interfaces[name]

    def in_part_axes(load: PartLoad) -> PartLoad:
        return load.placed(frame(load.interface)) if isinstance(load, InterfaceForce) else load

    cases = tuple(replace(case, loads=tuple(in_part_axes(load) for load in case.loads)) for case in settings.cases)
    flown = tuple(
        replace(case, points=tuple(tuple(frame(interface)[:3, 3]) for interface, _ in case.seats))
        for case in settings.flown
    )
    masses = tuple(
        mass.placed(frame(mass.interface) if mass.interface else np.eye(4)) if isinstance(mass, CarriedMass) else mass
        for mass in settings.masses
    )
    return replace(settings, cases=cases, flown=flown, masses=masses)


def default_case(part: Part, settings: StressSettings) -> _core.PartCase:
    """Clamped and pressed faces by name; edge length as asked for, else from the mean wall thickness."""
    surface = part.fem_surface(settings.geometry, settings.segments)
    edge_length = _edge_length(part, surface, settings)
    for case in settings.cases:
        for load in case.loads:
            if isinstance(load, fem.BearingLoad) and isinstance(load.where, str) and load.where in surface.face_names:
                try:
                    require_bearing(surface, load.where, load.force)
                except ModelError as error:
                    raise ModelError(f"{part.name}, load case {case.name}: bearing_n on {error}") from None
    cases = load_cases(settings, lambda load: face_force(surface, load, part.name))
    return native_case(settings, surface, fem.default_size(surface, edge_length), held_faces(settings.supports), cases)


def _edge_length(part: Part, surface: fem.SurfaceMesh, settings: StressSettings) -> float:
    """Of the elements [m]; the peak's own size is found by refining."""
    share = FINE_EDGE_SHARE if settings.accuracy == "fine" else EDGE_SHARE
    if settings.edge_length is not None:
        return settings.edge_length * (share / EDGE_SHARE)
    corners = surface.points[surface.triangles]
    areas = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    volume = part.mass_properties().volume
    affordable = np.cbrt(8.0 * volume / MOST_ELEMENTS)  # a long thin tube: fewer elements across its wall
    return float(max(2.0 * volume / areas.sum() * EDGE_SHARE, affordable) * (share / EDGE_SHARE))


def as_given(load: fem.AffineTraction) -> fem.Load:
    """A force at a point acts on the whole of its face."""
    return load


def same_mass(mass: fem.RemoteMass) -> fem.RemoteMass:
    """A mass sits on the whole of its face."""
    return mass


def load_cases(
    settings: StressSettings,
    on_face: Callable[[PressedFace | PushedFace], fem.Load],
    at_point: Callable[[fem.AffineTraction], fem.Load] = as_given,
) -> list[fem.LoadCase]:
    """The load cases of a part as the solver takes them.

    on_face, at_point: what a total force on a face, and a force at a point of the part, mean for the part.
    """

    def solvable(load: PartLoad) -> fem.Load:
        if isinstance(load, PressedFace | PushedFace):
            return on_face(load)
        if isinstance(load, fem.AffineTraction):
            return at_point(load)
        if isinstance(load, InterfaceForce):
            raise TypeError("a force at an interface needs its place: use part_case")
        return load

    return [
        fem.LoadCase(
            case.name,
            [solvable(load) for load in case.loads],
            1.0 if case.safety_factor_min is None else case.safety_factor_min,
        )
        for case in settings.cases
    ]


def unit_loads(case: FlownCase, at_point: Callable[[fem.AffineTraction], fem.Load] = as_given) -> list[list[fem.Load]]:
    """Unit loads of a flown case; what a flight gives are factors on them, in this order.

    Force and moment along each axis of every seat, acceleration, its gradient (row by row) about the part's origin.
    """
    units: list[list[fem.Load]] = []
    for (_, face), point in zip(case.seats, case.points, strict=True):
        units += [[at_point(fem.AffineTraction(face, axis, point))] for axis in np.eye(3)]
        units += [[at_point(fem.AffineTraction(face, np.zeros(3), point, axis))] for axis in np.eye(3)]
    units += [[fem.Acceleration(axis)] for axis in np.eye(3)]
    return units + [[fem.Acceleration(np.zeros(3), entry.reshape(3, 3))] for entry in np.eye(9)]


def face_force(surface: fem.SurfaceMesh, load: PressedFace | PushedFace, part: str) -> fem.Force:
    """The total force of a load on a named face of a part's surface. Raises: StudyError (no such face), ModelError."""
    if load.face not in surface.face_names:
        raise StudyError(f"{part}: no face {load.face!r}; {nearest(load.face, filter(None, surface.face_names))}")
    if isinstance(load, PressedFace):
        try:
            force = load.along(pressing_direction(surface, load.face))
        except ModelError as error:
            raise ModelError(f"{part}: pressing_n on {error}") from None
    else:
        force = load.along(())
    if not force.any():
        raise ModelError(f"{part}: the force on face {load.face!r} is zero")
    return fem.Force(load.face, force)


def pressing_direction(surface: fem.SurfaceMesh, face: str) -> Vector:
    """(3,) unit vector against the mean outward normal of a named face.

    Raises: ModelError: its normals cancel, as those of a whole bore do.
    """
    corners = surface.points[surface.triangles[np.asarray(surface.face) == surface.face_names.index(face)]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    direction = -normals.sum(axis=0)
    length = float(np.linalg.norm(direction))
    share = length / float(np.linalg.norm(normals, axis=1).sum())
    if share < LEAST_MEAN_NORMAL:
        raise ModelError(
            f"face {face!r}: its normals cancel (their mean has the length {share:.2g}), so there is no direction to "
            "press in; give the force as a vector, force_n = [x, y, z]"
        )
    return np.asarray(direction / length)


def require_bearing(surface: fem.SurfaceMesh, face: str, force: ArrayLike) -> None:
    """A pin can press on a named face with a total force (3,) [N].

    Raises: ModelError: the force has a part along the axis of the bore, or points away from the whole face.
    """
    corners = surface.points[surface.triangles[np.asarray(surface.face) == surface.face_names.index(face)]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(normals, axis=1)
    values, axes = np.linalg.eigh(np.einsum("ni,nj,n->ij", normals, normals, 1.0 / np.maximum(areas, 1e-300)))
    wanted = np.asarray(force, dtype=float)
    along = axes[:, values < FLAT * values[2]].T @ wanted  # directions that no normal has a part in
    if np.linalg.norm(along) > ALONG_AXIS * np.linalg.norm(wanted):
        raise ModelError(
            f"face {face!r}: {np.linalg.norm(along):.4g} N of it are along the face (the axis of a bore), where a pin "
            "slides; give that part as a force of its own, force_n"
        )
    if not (normals @ wanted < 0.0).any():
        raise ModelError(f"face {face!r}: the force points away from the face, which a pin only presses on")


def held_face(text: str) -> tuple[str, str]:
    """Face and directions of an entry of `supports`: `FACE` is held in all, `FACE: xz` in two (a bolt's hole)."""
    face, colon, axes = (part.strip() for part in text.rpartition(":"))
    return (face, axes) if colon and axes and set(axes) <= set("xyz") else (text.strip(), "xyz")


def held_faces(supports: Sequence[str]) -> list[fem.Support]:
    """Supports of the entries of `supports`: all clamps as one, then what is held in some directions."""
    entries = [held_face(text) for text in supports]
    clamped = [face for face, axes in entries if axes == "xyz"]
    partly = [fem.Support(fem.select_names(face), axes) for face, axes in entries if axes != "xyz"]
    return [*([clamp(*clamped)] if clamped else []), *partly]


def clamp(*faces: str) -> fem.Support:
    """Named faces fixed in all directions."""
    return fem.Support(fem.select_names(*faces))


def native_case(
    settings: StressSettings,
    surface: fem.SurfaceMesh,
    size: fem.SizeField,
    supports: Sequence[fem.Support],
    cases: Sequence[fem.LoadCase],
    *,
    copies: int = 1,
    facet_angle_deg: float = 25.0,
    stretch: _core.Stretch | None = None,
    at_point: Callable[[fem.AffineTraction], fem.Load] = as_given,
    mass_on: Callable[[fem.RemoteMass], fem.RemoteMass] = same_mass,
) -> _core.PartCase:
    """What `codesign._core.evaluate` meshes and solves.

    copies: 2 for one half of a symmetric part; work and stress_50 then refer to the whole part. stretch: from the body
    of the surface to the part (codesign.parts.stretch). at_point: as in `load_cases`, for the unit loads of flown
    cases; mass_on: the same for masses.
    """
    static = _core.fem.StaticSettings()
    static.exclusion = getattr(_core.fem.ExclusionRule, settings.exclusion)
    static.exclusion_distance = settings.exclusion_distance
    static.copies = copies
    static.memory_limit = settings.memory_limit
    static.eigenvalues = max(settings.modes, settings.buckling)
    case = _core.PartCase(
        surface=surface,
        size=size,
        material=settings.material,
        supports=native_supports(None, supports),
        cases=[
            _core.LoadCase(case.name, native_loads(None, case.loads), case.safety_factor_min, case.antisymmetric)
            for case in cases
        ],
        settings=static,
        facet_angle_deg=facet_angle_deg,
        tolerance=settings.tolerance,
        max_refinements=MAX_REFINEMENTS if settings.accuracy == "converged" else 0,
    )
    case.stretch = stretch
    case.varying = [
        _core.VaryingCase(flown.name, [native_loads(None, unit) for unit in unit_loads(flown, at_point)])
        for flown in settings.flown
    ]
    case.masses = [mass_on(mass).native(None) for mass in settings.masses if isinstance(mass, fem.RemoteMass)]
    case.modes = settings.modes
    case.buckling = settings.buckling
    return case
