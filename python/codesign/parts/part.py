"""Parts: named parameters first, shape after; everything else (mesh, mass, files) follows from those two."""

from __future__ import annotations

import dataclasses
import math
import os
from abc import ABC, abstractmethod
from dataclasses import KW_ONLY, dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any, ClassVar

from codesign.errors import GeometryError
from codesign.geometry.exact import exact_moments, has_exact
from codesign.geometry.mass import MassProperties, extrapolate, mass_properties, settled, volume_moments
from codesign.geometry.mesh_files import write_stl
from codesign.geometry.profile import Resolution, Vector
from codesign.geometry.shape import Shape, face_names
from codesign.geometry.solid import Solid, build_solid
from codesign.parts.stretch import require_prism, stretched
from codesign.parts.surface import SurfaceMesh, surface_mesh

if TYPE_CHECKING:
    from codesign import _core

_PARAMETER = "codesign.parameter"
COARSE_RESOLUTION = Resolution(segments=24, chord_mm=0.12)  # of the coarsest mesh that mass is extrapolated from
EXPORT_RESOLUTION = Resolution(segments=4096, chord_mm=0.01)
SURFACE_RESOLUTION = replace(COARSE_RESOLUTION, refine=2)  # of the next finer one: 48 chords on a full circle
FEM_CHORD_MM = 0.03  # between chord and arc of small circles at 48 segments: stresses do not change with less


@dataclass(frozen=True, slots=True)
class ParameterInfo:
    """Unit and valid range of a part's parameter; the bounds themselves are valid."""

    unit: str
    minimum: float
    maximum: float


def parameter(unit: str, minimum: float = -math.inf, maximum: float = math.inf, **field: Any) -> Any:
    """Declares a dataclass field as a parameter of a part, with its unit and range."""
    return dataclasses.field(metadata={_PARAMETER: ParameterInfo(unit, minimum, maximum)}, **field)


def parameter_units(part_class: type[Part]) -> dict[str, str]:
    """Unit of each parameter of a part class."""
    return {f.name: f.metadata[_PARAMETER].unit for f in dataclasses.fields(part_class) if _PARAMETER in f.metadata}


@dataclass(frozen=True)
class Part(ABC):
    """Base of all parts; a subclass is a frozen dataclass with parameters and a `shape()`. Lengths in mm inside it.

    name: of the part in studies and files.   density: [kg/m³].
    load_variants, support_variants: values of a study's `[fem] load` and `support` that the class knows (a class with
    its own `stress_case` may know more).
    """

    load_variants: ClassVar[tuple[str, ...]] = ("uniform",)
    support_variants: ClassVar[tuple[str, ...]] = ("published",)

    _: KW_ONLY
    name: str
    density: float

    def __post_init__(self) -> None:
        for field in dataclasses.fields(self):
            info = field.metadata.get(_PARAMETER)
            if info is not None:
                self.limit(field.name, info.minimum, info.maximum)
        if not (math.isfinite(self.density) and self.density > 0.0):
            raise GeometryError(f"{self.name}: density = {self.density!r} kg/m³ must be positive")
        self.check()

    @abstractmethod
    def shape(self) -> Shape:
        """The part as an expression of the part language, in mm."""

    def fem_shape(self, geometry: str = "simplified") -> Shape:
        """The shape to be analyzed: "full", or "simplified" without features that hardly affect stress."""
        if geometry not in ("full", "simplified"):
            raise ValueError(f"geometry = {geometry!r}: must be 'full' or 'simplified'")
        return self.shape()

    def through_holes(self) -> int | None:
        """Number of through holes (genus) of the shape; checked whenever it is built, unless None."""
        return None

    def interfaces(self) -> dict[str, Vector]:
        """Frames at which other bodies are attached: name -> part_T_interface (4, 4) [m]; z points out of the part."""
        return {}

    def fits(self) -> dict[float, str]:
        """Fits of bores: diameter [mm] -> class of ISO 286, as `H7`; written into the STEP file and on the drawing."""
        return {}

    def positions(self) -> dict[str, float]:
        """Face -> width [mm] of the zone about its place in which it must lie, against the largest named flat face.

        Of named flat faces; written into the STEP file and on the drawing, where that one is datum A.
        """
        return {}

    def stretched_from(self) -> tuple[Part, _core.Stretch] | None:
        """A part that is this one when stretched where all its cross sections are equal; None: no other is.

        Parts that are stretched from one share meshes: of surface, mass and clearances, and in their `stress_case`. A
        worker takes them by preference.
        """
        return None

    def check(self) -> None:  # noqa: B027 (most parts need no more than the ranges of their parameters)
        """Refuses parameter values that give no sound part, by `limit`; called on construction."""

    def limit(
        self, parameter: str, minimum: float = -math.inf, maximum: float = math.inf, because: str = "valid range"
    ) -> None:
        """Checks a parameter, in its own unit. Raises: GeometryError with its value, limit and reason."""
        value = getattr(self, parameter)
        infos = (f.metadata.get(_PARAMETER) for f in dataclasses.fields(self) if f.name == parameter)
        unit = next((info.unit for info in infos if info is not None), "mm")
        if not math.isfinite(value):
            raise GeometryError(f"{self.name}: {parameter} = {value!r} is not a finite number")
        for broken, side, bound in ((value < minimum, "below", minimum), (value > maximum, "above", maximum)):
            if broken:
                limit = f"{side} its limit {bound:.10g} {unit} ({because})"
                raise GeometryError(f"{self.name}: {parameter} = {value:.10g} {unit} is {limit}")

    @property
    def parameters(self) -> dict[str, float]:
        """Parameter values by name, in the part's units (mm, deg)."""
        return {f.name: getattr(self, f.name) for f in dataclasses.fields(self) if _PARAMETER in f.metadata}

    def mirrored(self, axis: str, name: str) -> MirroredPart:
        """The mirror image in the plane through the part's origin normal to "x", "y" or "z", as a part `name`."""
        return MirroredPart(self, axis, name=name, density=self.density)

    @property
    def faces(self) -> tuple[str, ...]:
        """Names of the named faces."""
        return face_names(self.shape())

    def solid(self, resolution: Resolution = SURFACE_RESOLUTION) -> Solid:
        """Closed triangle mesh in mm.

        Raises: GeometryError if it is not one body with the expected holes and all named faces.
        """
        return _solid(self, resolution)

    def shared_solid(self, resolution: Resolution = SURFACE_RESOLUTION) -> Solid:
        """As `solid`, but stretched from the mesh of another part where there is one; see `stretched_from`.

        The same body up to rounding, whatever was made before; flat faces may be divided into other triangles.
        """
        return _mesh(self, resolution).tidied()

    def surface(self, segments: int | None = None) -> SurfaceMesh:
        """Closed surface in meters with named faces.

        segments: chords on a full circle, fewer on small ones; None: 48, `shared_solid`, of which the mass is made too.
        """
        return surface_mesh(self.shared_solid() if segments is None else self.solid(Resolution(segments)))

    def fem_surface(self, geometry: str = "simplified", segments: int = 48, **variant: Any) -> SurfaceMesh:
        """Closed surface in meters of the shape to be analyzed; `geometry` and `variant` as in `fem_shape`."""
        return _fem_surface(self, geometry, segments, tuple(variant.items()))

    def mass_properties(self) -> MassProperties:
        """Mass (to 1e-5), center of mass and inertia (to 5e-5) of the true curved solid, part frame, SI."""
        return mass_properties(_moments(self), self.density)

    @property
    def title(self) -> str:
        """Name and parameter values in one line."""
        return " ".join([self.name, *(f"{name}={value:g}" for name, value in self.parameters.items())])

    def write_stl(self, path: str | os.PathLike[str], resolution: Resolution = EXPORT_RESOLUTION) -> None:
        """Binary STL in mm; by default chords stay within 0.01 mm of the true surface."""
        write_stl(self.solid(resolution), path, self.title)


@dataclass(frozen=True)
class MirroredPart(Part):
    """The other side: a part's mirror image in the plane through its origin normal to `axis`; the same face names."""

    original: Part
    axis: str

    def shape(self) -> Shape:
        """The mirrored expression."""
        return self.original.shape().mirrored(self.axis)

    def fem_shape(self, geometry: str = "simplified", **variant: Any) -> Shape:
        """The mirror image of the original's."""
        return self.original.fem_shape(geometry, **variant).mirrored(self.axis)

    def through_holes(self) -> int | None:
        """As the original."""
        return self.original.through_holes()

    def fits(self) -> dict[float, str]:
        """Of the original: diameter [mm] -> tolerance."""
        return self.original.fits()

    def positions(self) -> dict[str, float]:
        """Of the original: face -> tolerance [mm]."""
        return self.original.positions()

    def solid(self, resolution: Resolution = SURFACE_RESOLUTION) -> Solid:
        """The mirror image of the original's mesh."""
        return self.original.solid(resolution).mirrored(self.axis)

    def shared_solid(self, resolution: Resolution = SURFACE_RESOLUTION) -> Solid:
        """The mirror image of the original's."""
        return self.original.shared_solid(resolution).mirrored(self.axis)

    def mass_properties(self) -> MassProperties:
        """Those of the original, mirrored."""
        return self.original.mass_properties().mirrored(self.axis)

    @property
    def parameters(self) -> dict[str, float]:
        """Those of the original, in their own units."""
        return self.original.parameters


@lru_cache(maxsize=8)
def _solid(part: Part, resolution: Resolution) -> Solid:
    """Mesh of a part; the last ones are kept, since surface and files ask for the same."""
    return _checked(part.shape(), resolution, part.through_holes()).tidied()


def _mesh(part: Part, resolution: Resolution) -> Solid:
    """Mesh that many parts share, of the part itself or stretched from that of another; not tidied."""
    found = part.stretched_from()
    if found is None:
        return _made(part, resolution)
    other, stretch = found
    solid = _made(other, resolution)
    require_prism(solid, stretch)
    return stretched(solid, stretch)


@lru_cache(maxsize=256)
def _made(part: Part, resolution: Resolution) -> Solid:
    """Mesh of a part as booleans leave it; kept (0.1 MB), since many parts are stretched from it."""
    return _checked(part.shape(), resolution, part.through_holes())


@lru_cache(maxsize=128)
def _fem_surface(part: Part, geometry: str, segments: int, variant: tuple[tuple[str, Any], ...]) -> SurfaceMesh:
    """Surface to be analyzed; kept, since designs that are stretched from one share it."""
    resolution = Resolution(segments, FEM_CHORD_MM * (48.0 / segments) ** 2)
    return surface_mesh(_checked(part.fem_shape(geometry, **dict(variant)), resolution).tidied())


@lru_cache(maxsize=4096)
def _moments(part: Part) -> Vector:
    """Volume moments (10,) in mm of the true curved solid; a round part needs a third mesh, an imported one none.

    Kept for a whole search: designs share parts, and ten numbers are little.
    """
    if has_exact(part.shape()):
        return exact_moments(part.shape())
    coarse, fine = _mesh_moments(part, 1), _mesh_moments(part, 2)
    return extrapolate(coarse, fine, None if settled(coarse, fine) else _mesh_moments(part, 4))


def _mesh_moments(part: Part, refine: int) -> Vector:
    solid = _mesh(part, replace(COARSE_RESOLUTION, refine=refine))
    return volume_moments(solid.points, solid.triangles)


def _checked(shape: Shape, resolution: Resolution, genus: int | None = None) -> Solid:
    """Mesh of a shape on which every face that the shape names is really there."""
    solid = build_solid(shape, resolution, genus)
    missing = [name for name in face_names(shape) if name not in solid.names]
    if missing:
        raise GeometryError(f"face {missing[0]!r} has vanished: other features cover or remove it")
    return solid
