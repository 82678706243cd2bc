"""Jetpack bracket: two slabs, a flat base bolted to the jetpack and one bent upwards that carries a turbine.

Part frame (mm): z = 0 lower face of the base, z up; x away from the robot; y = 0 symmetry plane. Used on both sides.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass, replace

import numpy as np

from codesign import _core, fem
from codesign.errors import GeometryError
from codesign.geometry.profile import Path, Vector
from codesign.geometry.shape import Extrusion, Frame, Shape, at_points, box, cylinder, polar, stepped_hole, union
from codesign.parts.load_case import (
    PressedFace,
    PushedFace,
    StressSettings,
    held_faces,
    load_cases,
    native_case,
)
from codesign.parts.part import Part, parameter
from codesign.parts.stretch import meshed_length, stretch_mm
from codesign.parts.symmetry import PLANE, Parity, is_symmetric, parity
from codesign.units import MILLIMETER

BASE = 15.0  # thickness of the base; the slab's is a field, see `thickness`
HALF_WIDTH = 30.0
LOWER_CREASE = 25.0  # x of the crease on the lower faces
NECK_END, NECK_WIDTH, NECK_RADIUS = 20.0, 20.0, 5.0  # x where the neck's rounds end, half width
SEAT_RADIUS, SEAT_DEPTH = 23.0, 1.0
SEAT_HOLE_RADIUS = 1.6
SEAT_HOLES = polar(19.7, 10.0, -10.0, 110.0, -110.0, 130.0, -130.0)
BENT_HOLES = [hole for hole in SEAT_HOLES if hole[0] < 0.0]  # those towards the crease, where the slab bends
SCREWS = [(4.0, 10.0), (4.0, -10.0)]
COUNTERBORE_RADIUS, COUNTERBORE_DEPTH = 3.0, 3.4  # of the seat's holes, from the upper face
SCREW_RADIUS = 4.2
TURBINE_REACH = 95.0  # from the seat's center to the turbine's axis on the right; 94.5 on the left
MINIMUM_WALL = 2.0
TYPICAL_ZONE, SHORTEST_ZONE = 54.0, 6.0  # of the slab, that is stretched; what is meshed must be a part too
FAR = 400.0  # beyond the part, for tools that cut through


@dataclass(frozen=True)
class JetpackBracket(Part):
    """Bracket with its slab bent by `angle` and the turbine seat at `distance` from the upper crease.

    thickness: of the tilted slab; 15, or 14.9994 as in the published parts (`as_published`).
    seat_analyzed: whether the solid that is analyzed in a search keeps the seat's pocket and the four holes of it that
    are nearer to the crease. Their counterbores' edges carry the peak where a turbine's thrust bends the slab; a load
    spread over the seat does not reach them.
    """

    load_variants = ("uniform", "thrust_line")
    support_variants = ("published", "bolted")

    angle: float = parameter("deg", minimum=0.5, maximum=89.5)
    distance: float = parameter("mm", minimum=0.0, maximum=400.0)
    _: KW_ONLY
    name: str = "jetpack_bracket"
    density: float = 2800.0  # aluminium 7075, as in the published masses
    thickness: float = 15.0
    seat_analyzed: bool = False

    @classmethod
    def as_published(cls, angle: float, distance: float) -> JetpackBracket:
        """The bracket of the published data base, whose tilted slab is 14.9994 mm thick."""
        return cls(angle, distance, thickness=14.9994)

    @property
    def _along(self) -> tuple[float, float, float]:
        a = math.radians(self.angle)
        return (math.cos(a), 0.0, math.sin(a))

    @property
    def _upper_crease_x(self) -> float:
        a = math.radians(self.angle)
        return LOWER_CREASE - BASE * math.tan(a / 2.0) + (BASE - self.thickness) / math.sin(a)

    @property
    def _seat_frame(self) -> Frame:
        """Origin in the seat's center on the slab's lower face, x along the slab, z from there into the slab."""
        crease = Frame((self._upper_crease_x, 0.0, BASE), self._along, (0.0, 1.0, 0.0))
        return crease.at(self.distance, 0.0, -self.thickness)

    def check(self) -> None:
        """Walls between the creases and the features beside them."""
        screw_edge = SCREWS[0][0] + SCREW_RADIUS
        steepest = 2.0 * math.degrees(math.atan((LOWER_CREASE - screw_edge - MINIMUM_WALL) / BASE))
        wall = f"{MINIMUM_WALL:g} mm wall"
        self.limit("angle", maximum=steepest, because=f"{wall} between screw holes and upper crease")
        lower_to_upper = BASE * math.tan(math.radians(self.angle) / 2.0)
        nearest = max(SEAT_RADIUS - lower_to_upper, COUNTERBORE_RADIUS - SEAT_HOLES[-1][0]) + MINIMUM_WALL
        self.limit("distance", minimum=nearest, because=f"{wall} between seat and creases")
        self.limit("thickness", minimum=SEAT_DEPTH + COUNTERBORE_DEPTH + MINIMUM_WALL, because=f"{wall} under the seat")

    def through_holes(self) -> int:
        """Six holes of the seat and two screws; the dowel hole is blind."""
        return 8

    def fits(self) -> dict[float, str]:
        """The dowel hole takes an m6 or h8 pin."""
        return {4.0: "H7"}

    def shape(self) -> Shape:
        """The part as it is made."""
        return self._build()

    def fem_shape(self, geometry: str = "simplified", support: str = "published", half: bool = True) -> Shape:
        """The part, or its half y >= 0 with the face `symmetry`, as it is analyzed.

        geometry: "full"; "simplified" without screw and dowel holes and, unless `seat_analyzed`, without the seat's
        pocket and holes; with it, without the two holes at the free end. Without pocket `seat` is the slab's whole
        lower face and the load acts on the disc `seat_radius` about `seat_center`. support: "published" names both
        base faces up to the creases `mount`; "bolted" names the contact with the jetpack `pad` and the screws'
        `screw_seat` instead.
        """
        if geometry not in ("full", "simplified") or support not in ("published", "bolted"):
            raise ValueError(f"geometry = {geometry!r}, support = {support!r}: no such variant")
        return self._build(
            seat_holes=self._seat_holes(geometry),
            screws=geometry == "full" or support == "bolted",
            dowel=geometry == "full",
            bolted=support == "bolted",
            half=half,
        )

    def _seat_holes(self, geometry: str) -> Sequence[tuple[float, float]]:
        """Holes of the seat that a solid that is analyzed has; none: it has no pocket either."""
        if geometry == "full":
            return SEAT_HOLES
        return BENT_HOLES if self.seat_analyzed else []

    def _build(
        self,
        seat_holes: Sequence[tuple[float, float]] = SEAT_HOLES,
        screws: bool = True,
        dowel: bool = True,
        bolted: bool = False,
        half: bool = False,
    ) -> Shape:
        shape = self._slabs("" if bolted else "mount", "" if seat_holes else "seat")
        if bolted:
            pad = box((-20.0, -20.0, 0.0), (min(20.0, self._upper_crease_x), 20.0, BASE), z1="pad")
            shape = union(shape - pad, pad)
        if seat_holes:
            for tool in self._seat_tools(seat_holes):
                shape = shape - tool
        if screws:
            screw = stepped_hole((7.0, -1.0, 9.0), (SCREW_RADIUS, 9.0, BASE + 1.0), shoulder_face="screw_seat")
            shape = shape - at_points(screw, SCREWS)
        if dowel:
            shape = shape - cylinder(2.0, BASE - 7.5, BASE + 1.0).moved(-10.0)
        if half:
            shape = shape - box((-FAR, -FAR, -FAR), (2.0 * FAR, 0.0, 2.0 * FAR), y1="symmetry")
        return shape

    def _slabs(self, mount: str, lower_face: str) -> Shape:
        """Base and tilted slab from one side profile, with the neck and the round free end cut out."""
        slab = self._seat_frame
        tip = HALF_WIDTH + 5.0
        (x0, _, z0), (x1, _, z1) = slab.point(tip, 0.0), slab.point(tip, 0.0, self.thickness)
        side = (
            Path(-20.0, 0.0).line(LOWER_CREASE, 0.0, face=mount)
            .line(x0, z0, face=lower_face).line(x1, z1)
            .line(self._upper_crease_x, BASE).line(-20.0, BASE, face=mount).close()
        )  # fmt: skip
        body = Extrusion(side, -HALF_WIDTH, HALF_WIDTH, Frame(x=(1.0, 0.0, 0.0), y=(0.0, 0.0, 1.0)))
        x, w = NECK_END - NECK_RADIUS, NECK_WIDTH
        neck = (
            Path(-21.0, w).line(x, w).arc(NECK_END, w + NECK_RADIUS, center=(x, w + NECK_RADIUS)).line(NECK_END, 31.0)
            .line(-21.0, 31.0).close()
        )  # fmt: skip
        beside_neck = Extrusion(neck, -1.0, BASE)
        r = HALF_WIDTH
        round_end = (
            Path(0.0, r).arc(0.0, -r, center=(0.0, 0.0), turn="right").line(0.0, -r - 1.0)
            .line(tip + 1.0, -r - 1.0).line(tip + 1.0, r + 1.0).line(0.0, r + 1.0).close()
        )  # fmt: skip
        beyond_end = Extrusion(round_end, -1.0, self.thickness + 1.0).placed(slab)
        return body - beside_neck - beside_neck.mirrored("y") - beyond_end

    def _seat_tools(self, holes: Sequence[tuple[float, float]]) -> list[Shape]:
        """Pocket in the lower face and counterbored holes around its center."""
        top = self.thickness
        shoulder = top - COUNTERBORE_DEPTH
        hole = stepped_hole((SEAT_HOLE_RADIUS, 0.0, shoulder), (COUNTERBORE_RADIUS, shoulder, top + 1.0))
        pocket = cylinder(SEAT_RADIUS, -1.0, SEAT_DEPTH, end_face="seat")
        return [tool.placed(self._seat_frame) for tool in (pocket, at_points(hole, holes))]

    def interfaces(self) -> dict[str, Vector]:
        """turbine_seat: middle of the pocket's floor, x along the slab away from the crease, z out of the floor."""
        x, z = self.slab_direction, -self.slab_normal
        part_T_seat = np.eye(4)
        part_T_seat[:3, :3] = np.column_stack([x, np.cross(z, x), z])
        part_T_seat[:3, 3] = np.array(self._seat_frame.point(0.0, 0.0, SEAT_DEPTH)) * MILLIMETER
        return {"turbine_seat": part_T_seat}

    # What a load case needs to know, in meters and part axes.

    seat_radius = SEAT_RADIUS * MILLIMETER

    @property
    def seat_center(self) -> Vector:
        """(3,) center of the seat on the slab's lower face [m]; the pocket's floor is 1 mm further along the normal."""
        return np.array(self._seat_frame.origin) * MILLIMETER

    @property
    def slab_direction(self) -> Vector:
        """(3,) unit vector along the slab, from the crease to the free end."""
        return np.array(self._along)

    @property
    def slab_normal(self) -> Vector:
        """(3,) unit vector from the slab's lower face, which carries the turbine, to its upper face."""
        return np.array(self._seat_frame.z)

    @property
    def lower_crease(self) -> Vector:
        """(3,) point of the lower crease in the plane of symmetry [m]; the crease is parallel to y."""
        return np.array([LOWER_CREASE, 0.0, 0.0]) * MILLIMETER

    @property
    def upper_crease(self) -> Vector:
        """(3,) point of the upper crease in the plane of symmetry [m]; the crease is parallel to y."""
        return np.array([self._upper_crease_x, 0.0, BASE]) * MILLIMETER

    @property
    def turbine_axis(self) -> Vector:
        """(3,) point of the turbine's axis, which is parallel to the slab's normal, in the plane of the seat [m]."""
        return self.seat_center + TURBINE_REACH * MILLIMETER * self.slab_direction

    half_width = HALF_WIDTH * MILLIMETER

    def stress_case(self, settings: StressSettings) -> _core.PartCase:
        """The half y >= 0, or the whole part where that cannot stand for it; finest along both creases.

        Forces are tractions over the seat's disc, affine so that force and moment are exact. Total forces act at the
        center of the pocket's floor, or at the turbine's axis (`load = "thrust_line"`).
        """
        if settings.load not in ("uniform", "thrust_line"):
            raise GeometryError(f"{self.name}: load = {settings.load!r}: there are uniform and thrust_line")
        half = _half_stands_for(settings)
        supports = list(settings.supports) if settings.support == "published" else ["pad", "screw_seat"]
        meshed, stretch = self._stretched_from(settings)
        surface = meshed.fem_surface(settings.geometry, settings.segments, support=settings.support, half=half)
        center = self.turbine_axis if settings.load == "thrust_line" else self.seat_center
        slab = fem.Disc(self.seat_center, self.slab_normal, self.seat_radius)
        disc = None if self._seat_holes(settings.geometry) else slab
        mirror = PLANE if half else None

        def at_point(load: fem.AffineTraction) -> fem.Load:
            return replace(load, region=disc, mirror=mirror)

        def on_face(load: PressedFace | PushedFace) -> fem.Load:
            return at_point(fem.AffineTraction(load.face, load.along(self.slab_normal), center))

        def mass_on(mass: fem.RemoteMass) -> fem.RemoteMass:
            return replace(mass, region=disc, mirror=mirror)

        cases = [
            replace(case, antisymmetric=half and parity(given.loads) is Parity.ANTISYMMETRIC)
            for case, given in zip(load_cases(settings, on_face, at_point), settings.cases, strict=True)
        ]
        held = [*held_faces(supports), *([fem.Support("symmetry", axes="y", symmetry=True)] if half else [])]
        size = meshed._size_field(settings, half)
        return native_case(
            settings, surface, size, held, cases, copies=2 if half else 1, stretch=stretch, at_point=at_point,
            mass_on=mass_on,
        )  # fmt: skip

    def stretched_from(self) -> tuple[JetpackBracket, _core.Stretch] | None:
        """The bracket with a slab of one of few lengths."""
        return self._stretched(8.0, SEAT_RADIUS + 2.0)

    def _stretched(self, start: float, before_seat: float) -> tuple[JetpackBracket, _core.Stretch] | None:
        """As `stretched_from`, between distances from the crease and from the seat's center, in mm."""
        zone = self.distance - before_seat - start
        if zone < SHORTEST_ZONE:
            return None
        meshed = replace(self, distance=start + meshed_length(zone, TYPICAL_ZONE) + before_seat)
        end, change = meshed.distance - before_seat, self.distance - meshed.distance
        return meshed, stretch_mm(self.upper_crease, self.slab_direction, start, end, change)

    def _stretched_from(self, settings: StressSettings) -> tuple[JetpackBracket, _core.Stretch | None]:
        """The bracket that is meshed, and how its slab is stretched between creases and seat to be this one."""
        if settings.accuracy != "optimization" or settings.geometry == "full":
            return self, None
        found = self.stretched_from() if self._seat_holes(settings.geometry) else self._stretched(14.0, 0.0)
        return found or (self, None)

    def _size_field(self, settings: StressSettings, half: bool) -> fem.SizeField:
        """Fine along lines 2 mm behind each crease, on the side away from the clamp; the peak is at the upper one."""
        fine = settings.accuracy != "optimization"
        base, growth = (8.0, 0.35) if fine else (12.0, 0.6)
        lower, upper = ((0.5, 2.0), (0.5, 2.0)) if fine else ((1.1, 1.5), (0.9, 2.2))  # size, radius
        across = np.array([0.0, self.half_width, 0.0])
        behind = 2.0 * MILLIMETER * self.slab_direction
        sources = [
            fem.SizeSource(
                np.array([crease + behind - (0.0 if half else across), crease + behind + across]),
                size * MILLIMETER,
                growth,
                radius * MILLIMETER,
            )
            for crease, (size, radius) in ((self.lower_crease, lower), (self.upper_crease, upper))
        ]
        if self.seat_analyzed:
            sources += self._counterbore_sources(settings, half)
            sources += self._neck_sources(half)
        return fem.SizeField(base * MILLIMETER, sources)

    def _counterbore_sources(self, settings: StressSettings, half: bool) -> list[fem.SizeSource]:
        """Circles along the counterbores' edges on the slab's upper face, finest where the slab bends most."""
        turn = np.linspace(0.0, 2.0 * math.pi, 17)
        nearest = min(x for x, _ in SEAT_HOLES)
        fine = settings.accuracy != "optimization"
        sources = []
        for x, y in self._seat_holes(settings.geometry):
            if half and y < 0.0:
                continue
            size, growth, radius = (0.5, 0.35, 0.5) if fine else ((0.5 if x == nearest else 1.4), 0.5, 0.5)
            edge = zip(x + COUNTERBORE_RADIUS * np.cos(turn), y + COUNTERBORE_RADIUS * np.sin(turn), strict=True)
            points = np.array([self._seat_frame.point(*at, self.thickness) for at in edge]) * MILLIMETER
            sources.append(fem.SizeSource(points, size * MILLIMETER, growth, radius * MILLIMETER))
        return sources

    def _neck_sources(self, half: bool) -> list[fem.SizeSource]:
        """The neck's rounds beside the clamp, that bend where the turbine is pulled sideways."""
        x = min(max(self._upper_crease_x + 1.0, NECK_END - NECK_RADIUS), NECK_END)
        y = NECK_WIDTH + NECK_RADIUS - math.sqrt(NECK_RADIUS**2 - (x - NECK_END + NECK_RADIUS) ** 2)
        sides = (1.0,) if half else (1.0, -1.0)
        heights = np.array([BASE - 3.5, BASE - 1.5])
        lines = [np.array([[x, side * y, z] for z in heights]) * MILLIMETER for side in sides]
        return [fem.SizeSource(line, 0.8 * MILLIMETER, 0.5, 1.0 * MILLIMETER) for line in lines]


def _half_stands_for(settings: StressSettings) -> bool:
    """Whether all that is asked of the part can be said of its half y >= 0.

    A flight's loads are of no symmetry, and its modes with masses and its buckling under antisymmetric loads neither.
    """
    kinds = {parity(case.loads) for case in settings.cases}
    if settings.flown or Parity.NEITHER in kinds:
        return False
    placed = [mass for mass in settings.masses if isinstance(mass, fem.RemoteMass)]
    if placed and (settings.modes > 0 or not all(is_symmetric(mass) for mass in placed)):
        return False
    return settings.buckling == 0 or Parity.ANTISYMMETRIC not in kinds
