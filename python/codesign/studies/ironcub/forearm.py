"""Forearm jet support: wrist stub, flange, rod, collar and a clamp body of hub and ring, in one piece.

Part frame (mm) of the left part: the rod's axis is parallel to x through y = 15, z = 0; distal is -x; the ring hangs
towards -z. The right part is the mirror image in z.
"""

from __future__ import annotations

import math
from dataclasses import KW_ONLY, dataclass, replace

import numpy as np

from codesign import _core, fem
from codesign.errors import GeometryError
from codesign.geometry.profile import Path, Profile, Vector, circle
from codesign.geometry.shape import (
    Extrusion,
    Frame,
    Revolution,
    Shape,
    Triple,
    at_points,
    box,
    cylinder,
    polar,
    stepped_hole,
    union,
)
from codesign.parts.load_case import (
    PartLoad,
    PressedFace,
    PushedFace,
    StressSettings,
    held_faces,
    load_cases,
    native_case,
)
from codesign.parts.part import Part, parameter
from codesign.parts.stretch import meshed_length, stretch_mm
from codesign.units import MILLIMETER

AXIS: Triple = (0.0, 15.0, 0.0)  # a point of the rod's axis
ALONG = Frame(AXIS, (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))  # for revolutions: (x, distance from the axis)
ACROSS = Frame(AXIS, (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))  # for outlines: (y', z), extruded along x
MOUNT_X, ROD_X, RELIEF_X = -6.0, -18.0, -23.0
ROD_RADIUS, COLLAR_RADIUS, SPIGOT_RADIUS = 9.0, 22.5, 12.5
FLANGE_RADIUS, FLANGE_HALF_WIDTH, FLANGE_FOOT = 18.0, 11.45, -15.0
STUB_RADIUS, GROOVE_RADIUS = math.sqrt(63.0), 5.937
RELIEF_FLOOR = -6.0
HUB_RADIUS, RING_RADIUS, BORE_RADIUS, BLEND_RADIUS = 27.5, 65.9, 60.9, 25.0
SCREW_HOLE = 2.0  # radius
FLANGE_HOLES = ((SCREW_HOLE, polar(11.7, 135.0, -135.0)), (1.25, polar(12.5, 160.0, -160.0)))
MINIMUM_WALL = 2.0
TYPICAL_ZONE, SHORTEST_ZONE = 72.0, 8.0  # of the rod, that is stretched
NOZZLE_REACH = 146.1  # from the distal face to the nozzle's exit


@dataclass(frozen=True)
class ForearmJetSupport(Part):
    """Left forearm support with the ring's axis `offset` below the rod and a rod of `length`.

    fillet, relief_fillet: radii at the rod's two ends and in the corners of the screw-head relief; 0 for the sharp
    corners of the published part (`as_published`). spot_face: radius of the seats that the heads of the flange's screws
    get in those roundings; 0 for none. The relief just clears the heads of M3 cap screws, 2.75.
    """

    load_variants = ("uniform", "thrust_line")

    offset: float = parameter("mm", minimum=0.0, maximum=200.0)
    length: float = parameter("mm", minimum=0.0, maximum=500.0)
    _: KW_ONLY
    name: str = "forearm_support"
    density: float = 4410.0  # titanium alloy, as in the published masses
    fillet: float = 2.0
    relief_fillet: float = 1.5
    spot_face: float = 2.75

    @classmethod
    def as_published(cls, offset: float, length: float) -> ForearmJetSupport:
        """The part of the published data base: sharp corners at the rod."""
        return cls(offset, length, fillet=0.0, relief_fillet=0.0, spot_face=0.0)

    def check(self) -> None:
        """Walls between bore and spigot, and of the neck between hub and ring."""
        smallest = BORE_RADIUS + SPIGOT_RADIUS + MINIMUM_WALL
        self.limit("offset", minimum=smallest, because=f"{MINIMUM_WALL:g} mm between the ring's bore and the spigot")
        neck = (HUB_RADIUS + BLEND_RADIUS, RING_RADIUS + BLEND_RADIUS, BLEND_RADIUS + MINIMUM_WALL)
        largest = math.sqrt(neck[0] ** 2 - neck[2] ** 2) + math.sqrt(neck[1] ** 2 - neck[2] ** 2)
        self.limit("offset", maximum=largest, because=f"{2 * MINIMUM_WALL:g} mm wall between hub and ring")
        relief = ROD_X - RELIEF_X
        self.limit("fillet", 0.0, FLANGE_HALF_WIDTH - ROD_RADIUS - 0.2, because="it must end on the flange")
        self.limit("relief_fillet", 0.0, 0.5 * relief, because="the relief has two of them")
        y, z = FLANGE_HOLES[0][1][0]
        to_rod = math.hypot(y - RELIEF_FLOOR, z - math.sqrt(ROD_RADIUS**2 - RELIEF_FLOOR**2))
        self.limit("spot_face", 0.0, to_rod, because="a wider one would cut into the rod")
        self.limit("length", minimum=relief + self.fillet + MINIMUM_WALL, because="relief and fillet beside each other")

    @property
    def _clamp_x(self) -> float:
        return -(34.0 + self.length)

    @property
    def _seat_x(self) -> float:
        return -(57.9 + self.length)

    def through_holes(self) -> int:
        """Four holes in the flange and the ring's bore."""
        return 5

    def shape(self) -> Shape:
        """The part as it is made."""
        return self._build()

    def fem_shape(self, geometry: str = "simplified") -> Shape:
        """The part as it is analyzed: "full", or "simplified" without stub, spigot and the flange's holes.

        Both have the faces `mount` and `seat`.
        """
        if geometry not in ("full", "simplified"):
            raise ValueError(f"geometry = {geometry!r}: must be 'full' or 'simplified'")
        whole = geometry == "full"
        return self._build(stub=whole, spigot=whole, holes=whole)

    def _build(self, stub: bool = True, spigot: bool = True, holes: bool = True) -> Shape:
        turned = self._turned(stub, spigot) - self._relief()
        if stub:
            flat = box((-8.0, 6.856, -4.0), (7.0, 10.0, 4.0), y0="mount", z0="mount", z1="mount").moved(*AXIS)
            turned = turned - flat - flat.rotated("x", 180.0, about=AXIS)
        clamp = Extrusion(self.clamp_outline(), self._seat_x, self._clamp_x, ACROSS, start_face="seat")
        shape = union(turned, self._flange(), clamp)
        for radius, centers in FLANGE_HOLES if holes else ():
            hole = cylinder(radius, RELIEF_X, -5.0)
            if radius == SCREW_HOLE and self.spot_face > radius:
                hole = stepped_hole((self.spot_face, RELIEF_X, ROD_X), (radius, ROD_X, -5.0))
            shape = shape - at_points(hole, centers).placed(ACROSS)
        return shape

    def _turned(self, stub: bool, spigot: bool) -> Shape:
        """Everything round about the axis in one profile: stub, rod with its end fillets, collar and spigot."""
        r, f, collar_x = ROD_RADIUS, self.fillet, ROD_X - self.length
        end = self._seat_x - 1.1 if spigot else self._clamp_x
        path = Path(end, 0.0)
        if stub:  # groove and cone; the stub starts inside the flange
            path = path.line(6.0, 0.0).line(6.0, STUB_RADIUS, face="mount").line(1.5, STUB_RADIUS, face="mount")
            path = path.line(1.5, GROOVE_RADIUS, face="mount").line(-1.5, GROOVE_RADIUS, face="mount")
            path = path.line(-1.5, 8.0, face="mount").line(MOUNT_X, STUB_RADIUS, face="mount").line(-10.0, STUB_RADIUS)
        else:
            path = path.line(-10.0, 0.0)
        path = path.line(-10.0, r + f)
        if f > 0.0:
            path = path.line(ROD_X, r + f).arc(ROD_X - f, r, center=(ROD_X - f, r + f), turn="right")
            path = path.line(collar_x + f, r).arc(collar_x, r + f, center=(collar_x + f, r + f), turn="right")
        else:
            path = path.line(collar_x, r)
        path = path.line(collar_x, COLLAR_RADIUS).line(self._clamp_x, COLLAR_RADIUS)
        if spigot:
            path = path.line(self._clamp_x, SPIGOT_RADIUS).line(end, SPIGOT_RADIUS)
        return Revolution(path.close(), ALONG)

    def _relief(self) -> Shape:
        """Tool that makes room for the heads of the flange's screws beside the rod."""
        outline = (
            Path(RELIEF_X, -30.0).line(ROD_X, -30.0).line(ROD_X, RELIEF_FLOOR, radius=self.relief_fillet)
            .line(RELIEF_X, RELIEF_FLOOR, radius=self.relief_fillet).close()
        )  # fmt: skip
        return Extrusion(outline, -30.0, 30.0, ALONG)

    def _flange(self) -> Shape:
        radius, half, foot = FLANGE_RADIUS, FLANGE_HALF_WIDTH, FLANGE_FOOT
        side, low = math.sqrt(radius**2 - half**2), math.sqrt(radius**2 - foot**2)
        center = (0.0, 0.0)
        outline = (
            Path(foot, -low).arc(-side, -half, center=center).line(side, -half).arc(side, half, center=center)
            .line(-side, half).arc(foot, low, center=center).close()
        )  # fmt: skip
        plate = Extrusion(outline, ROD_X, MOUNT_X, ACROSS, end_face="mount")
        edge_radius = 2.0  # both long edges, towards the mounting face
        corner = (
            Path(half, MOUNT_X - edge_radius).line(half + 1.0, MOUNT_X - edge_radius).line(half + 1.0, MOUNT_X + 1.0)
            .line(half - edge_radius, MOUNT_X + 1.0).line(half - edge_radius, MOUNT_X)
            .arc(half, MOUNT_X - edge_radius, center=(half - edge_radius, MOUNT_X - edge_radius), turn="right").close()
        )  # fmt: skip
        rounding = Extrusion(corner, -30.0, 30.0, Frame(AXIS, (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)))
        return plate - rounding - rounding.mirrored("z")

    def clamp_outline(self) -> Profile:
        """Outline of hub and ring in (y', z), joined by arcs tangent to both, with the ring's bore."""
        hub, ring, drop = HUB_RADIUS + BLEND_RADIUS, RING_RADIUS + BLEND_RADIUS, self.offset
        z = (ring**2 - hub**2 - drop**2) / (2.0 * drop)
        blend = np.array([math.sqrt(hub**2 - z**2), z])
        center = np.array([0.0, -drop])
        on_hub = HUB_RADIUS / hub * blend
        on_ring = center + RING_RADIUS / ring * (blend - center)
        (hy, hz), (ry, rz), (by, bz) = on_hub.tolist(), on_ring.tolist(), blend.tolist()
        outline = (
            Path(hy, hz).arc(-hy, hz, center=(0.0, 0.0))
            .arc(-ry, rz, center=(-by, bz), turn="right")
            .arc(ry, rz, center=(0.0, -drop))
            .arc(hy, hz, center=(by, bz), turn="right").close()
        )  # fmt: skip
        return outline.without(circle(0.0, -drop, BORE_RADIUS))

    def interfaces(self) -> dict[str, Vector]:
        """turbine: at the nozzle's exit of the turbine clamped in the ring, z along the jet, x parallel to part z."""
        part_T_turbine = np.eye(4)
        part_T_turbine[:3, :3] = [[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]]
        part_T_turbine[:3, 3] = np.array([self._seat_x - NOZZLE_REACH, AXIS[1], -self.offset]) * MILLIMETER
        return {"turbine": part_T_turbine}

    # What a load case needs to know, in meters and part axes.

    @property
    def seat_area(self) -> float:
        """Area of the distal face around the spigot [m²], exact."""
        return (self.clamp_outline().area - math.pi * SPIGOT_RADIUS**2) * MILLIMETER**2

    @property
    def seat_centroid(self) -> Vector:
        """(3,) centroid of the distal face around the spigot [m], exact."""
        outline = self.clamp_outline()
        area = outline.area - math.pi * SPIGOT_RADIUS**2  # the spigot is centered on the axis: no first moment
        y, z = (moment / area for moment in outline.first_moments)
        return np.array([self._seat_x, AXIS[1] + y, z]) * MILLIMETER

    @property
    def turbine_axis(self) -> Vector:
        """(3,) point of the turbine's axis, which is parallel to x, in the plane of the distal face [m]."""
        return np.array([self._seat_x, AXIS[1], -self.offset]) * MILLIMETER

    @property
    def rod_ends(self) -> tuple[Vector, Vector]:
        """Points of the rod's axis at the flange and at the collar [m]; the fillets lie between them."""
        start, end = ([x, AXIS[1], AXIS[2]] for x in (ROD_X, ROD_X - self.length))
        return np.array(start) * MILLIMETER, np.array(end) * MILLIMETER

    rod_radius = ROD_RADIUS * MILLIMETER

    def stress_case(self, settings: StressSettings) -> _core.PartCase:
        """The whole part, finest in the fillets at the rod's ends on the side of the ring, where thrusts bend it most.

        Loads across the rod bend it most at the flange: with any, the mesh is finer there and at the relief's corner.
        The load is a traction over the distal face, affine so that its resultant passes exactly through the centroid of
        the true face (which the spigot interrupts), or through the turbine's axis (`load = "thrust_line"`).
        """
        if settings.load not in ("uniform", "thrust_line"):
            raise GeometryError(f"{self.name}: load = {settings.load!r}: there are uniform and thrust_line")
        point = self.turbine_axis if settings.load == "thrust_line" else self.seat_centroid

        def traction(load: PressedFace | PushedFace) -> fem.Load:
            return fem.AffineTraction(load.face, load.along((1.0, 0.0, 0.0)), point)

        meshed, stretch = self._stretched_from(settings)
        return native_case(
            settings,
            meshed.fem_surface(settings.geometry, settings.segments),
            meshed._size_field(settings),
            held_faces(settings.supports),
            load_cases(settings, traction),
            facet_angle_deg=20.0,
            stretch=stretch,
        )

    def stretched_from(self) -> tuple[ForearmJetSupport, _core.Stretch] | None:
        """The support with a rod of one of few lengths."""
        start, end = ROD_X - RELIEF_X + 2.0, self.fillet + 3.0  # from the rod's ends
        zone = self.length - start - end
        if zone < SHORTEST_ZONE:
            return None
        meshed = replace(self, length=start + meshed_length(zone, TYPICAL_ZONE) + end)
        rod_start, _ = self.rod_ends
        along = np.array([-1.0, 0.0, 0.0])
        return meshed, stretch_mm(rod_start, along, start, meshed.length - end, self.length - meshed.length)

    def _stretched_from(self, settings: StressSettings) -> tuple[ForearmJetSupport, _core.Stretch | None]:
        """The support that is meshed, and how its rod is stretched to be this one."""
        if settings.accuracy != "optimization" or settings.geometry == "full":
            return self, None
        return self.stretched_from() or (self, None)

    def _size_field(self, settings: StressSettings) -> fem.SizeField:
        """Arcs inside the fillets at the rod's ends, finest on the side of the ring; the rod itself; the relief."""
        fine = settings.accuracy != "optimization"
        across = bool(settings.flown) or not all(_along_rod(load) for case in settings.cases for load in case.loads)
        base, near, far, opposite = (8.0, 0.35, 0.35, 2.0) if fine else (20.0, 0.45, 0.5 if across else 0.7, 3.0)
        growth, rod, rod_growth = (0.35, 4.0, 0.35) if fine else (0.5, 7.0, 0.8)
        start, end = self.rod_ends
        turn = np.radians(np.linspace(-20.0, 20.0, 9))
        inside = np.array([0.8 * MILLIMETER, 0.0, 0.0])
        sources = []
        for side, factor in ((-1.0, 1.0), (1.0, opposite)):
            arc = (self.rod_radius + 0.4 * MILLIMETER) * np.column_stack(
                [0.0 * turn, np.sin(turn), side * np.cos(turn)]
            )
            sources += [
                fem.SizeSource(center + arc, factor * size * MILLIMETER, growth, 0.6 * MILLIMETER)
                for center, size in ((start - inside, far), (end + inside, near))
            ]
        sources.append(fem.SizeSource(np.array([start, end]), rod * MILLIMETER, rod_growth, self.rod_radius))
        if across:
            sources += self._relief_sources(fine)
        return fem.SizeField(base * MILLIMETER, sources)

    def _relief_sources(self, fine: bool) -> list[fem.SizeSource]:
        """Lines in the relief's corner away from the flange, on both sides: where bending about z is largest."""
        size, growth = (0.3, 0.4) if fine else (0.5, 0.6)
        x, y = RELIEF_X + 1.0, AXIS[1] + RELIEF_FLOOR + 0.1
        lines = [np.array([[x, y, side * z] for z in (3.5, 5.0)]) * MILLIMETER for side in (-1.0, 1.0)]
        return [fem.SizeSource(line, size * MILLIMETER, growth, 0.6 * MILLIMETER) for line in lines]


def _along_rod(load: PartLoad) -> bool:
    """Whether a load bends the rod as a thrust does: evenly, in the plane of the rod's and the ring's axes."""
    if isinstance(load, PressedFace | fem.Pressure):
        return True
    if isinstance(load, PushedFace):
        return not any(load.force[1:])
    if isinstance(load, fem.AffineTraction):
        (_, y, z), (mx, _, mz) = np.asarray(load.force, dtype=float), np.asarray(load.moment, dtype=float)
        return bool(y == z == mx == mz == 0.0 and np.asarray(load.point)[1] == AXIS[1] * MILLIMETER)
    return isinstance(load, fem.Acceleration) and not (
        np.any(np.asarray(load.acceleration)[1:]) or np.any(load.gradient)
    )
