"""A workshop drawing of a part on one A3 sheet: three views in first angle, dimensions, bores, what it is made of.

The geometry that is not dimensioned is that of the STEP file, which the sheet names.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from codesign.errors import GeometryError
from codesign.geometry.brep import Brep
from codesign.geometry.features import Flat, flats
from codesign.geometry.profile import Vector
from codesign.parts.bores import Bore, bores
from codesign.parts.labels import label_circles
from codesign.parts.sheet import Line, Sheet, moved
from codesign.parts.views import View, project

WIDTH, HEIGHT = 420.0, 297.0  # A3
LEFT, RIGHT, BOTTOM, TOP = 20.0, 410.0, 10.0, 287.0  # frame
COLUMN = 284.0  # x of the right column
SCALES = (10.0, 5.0, 2.0, 1.0, 0.5, 0.2, 0.1, 0.05, 0.02)  # ISO 5455
TOLERANCE = "ISO 2768-mK"
FRONT, ABOVE, SIDE = ((0, -1, 0), (1, 0, 0)), ((0, 0, 1), (1, 0, 0)), ((-1, 0, 0), (0, -1, 0))
ROW, SMALL = 4.4, 2.0  # mm: lines of tables, their letters
SHARE = 0.02  # of the largest flat face: smaller ones get no dimension
ALIGNED = 1e-6  # of direction entries


@dataclass(frozen=True)
class Caption:
    """What a sheet says beside the geometry.

    name, title: of the part, with its parameters. material; mass [kg]; density [kg/m³]; quantity. design: its values in
    words; revision: its hash. model: file that holds the exact geometry. organization: who has it made. fits: bores'
    diameter [mm] and class of ISO 286. positions: faces and widths [mm] of the zones in which they lie.
    """

    name: str
    title: str
    material: str
    mass: float
    density: float
    quantity: int = 1
    design: str = ""
    revision: str = ""
    model: str = ""
    organization: str = ""
    fits: tuple[tuple[float, str], ...] = ()
    positions: tuple[tuple[str, float], ...] = ()


def draw_part(brep: Brep, caption: Caption) -> Sheet:
    """The drawing of a part. Raises: GeometryError if it is too large for the smallest scale."""
    sheet = Sheet(WIDTH, HEIGHT, f"{caption.name} {caption.revision}".strip())
    views = [project(brep.shape, np.array(towards), np.array(right)) for towards, right in (FRONT, ABOVE, SIDE)]
    holes, planes = bores(brep), flats(brep)
    scale, corners = _arranged(views)
    for view, corner in zip(views, corners, strict=True):
        _draw_view(sheet, view, scale, corner, holes)
    _dimension(sheet, views, corners, scale, planes)
    _tilts(sheet, views[0], corners[0], scale, planes)
    for view, corner in zip(views, corners, strict=True):
        _number(sheet, view, scale, corner, holes)
    low = _pictures(sheet, brep, holes, scale)
    _table(sheet, holes, low)
    _notes(sheet, caption)
    _title_block(sheet, caption, scale)
    return sheet


def _arranged(views: Sequence[View]) -> tuple[float, list[Vector]]:
    """Scale, and where the origin of each view lies: that from above below the front, that from the left beside it."""
    (front, above, side) = (view.bounds[1] - view.bounds[0] for view in views)
    for scale in SCALES:
        wide, high = scale * (front[0] + side[0]), scale * (front[1] + above[1])
        if wide <= COLUMN - LEFT - 82.0 and high <= TOP - BOTTOM - 92.0:
            break
    else:
        raise GeometryError(f"a part of {front[0]:.0f} x {front[1]:.0f} x {above[1]:.0f} mm has no drawing: too large")
    left = LEFT + 28.0 + 0.5 * (COLUMN - LEFT - 82.0 - wide)
    top = TOP - 18.0 - 0.4 * (TOP - BOTTOM - 92.0 - high)
    places = [
        (left, top - scale * front[1]),
        (left, top - scale * front[1] - 38.0 - scale * above[1]),
        (left + scale * front[0] + 24.0, top - scale * front[1]),
    ]
    return scale, [np.array(place) - scale * view.bounds[0] for view, place in zip(views, places, strict=True)]


def _draw_view(sheet: Sheet, view: View, scale: float, corner: Vector, holes: Sequence[Bore]) -> None:
    """Lines, and center marks of bores."""
    for strokes, pen in ((view.hidden, "hidden"), (view.visible, "visible")):
        sheet.lines += moved((Line(s.points, pen, s.circle) for s in strokes), scale, *corner.tolist())
    for hole in _seen_round(view, holes):
        x, y = (scale * view.place(hole.mouth) + corner).tolist()
        reach = scale * hole.largest + 2.0
        sheet.line("center", (x - reach, y), (x + reach, y))
        sheet.line("center", (x, y - reach), (x, y + reach))
    for hole in holes:
        if abs(float(hole.axis @ view.towards)) < ALIGNED:
            ends = np.array([hole.mouth + 2.0 / scale * hole.axis, hole.mouth - (hole.depth + 2.0 / scale) * hole.axis])
            sheet.line("center", *(tuple(p) for p in (scale * view.place(ends) + corner).tolist()))
            if not hole.hollow and view.towards[1] < -0.5:
                _boss(sheet, view, scale, corner, hole)


def _seen_round(view: View, holes: Sequence[Bore]) -> list[Bore]:
    """The bores that the view looks along."""
    return [hole for hole in holes if hole.hollow and abs(abs(float(hole.axis @ view.towards)) - 1.0) < ALIGNED]


def _number(sheet: Sheet, view: View, scale: float, corner: Vector, holes: Sequence[Bore]) -> None:
    """Numbers of the bores that the view looks along."""
    circles = {
        hole.label: (scale * view.place(hole.mouth) + corner, scale * hole.largest) for hole in _seen_round(view, holes)
    }
    label_circles(sheet, circles, SMALL)


def _boss(sheet: Sheet, view: View, scale: float, corner: Vector, boss: Bore) -> None:
    """The number of a boss that the view sees from the side, on its contour."""
    x, y = (scale * view.place(boss.mouth - 0.5 * boss.depth * boss.axis) + corner).tolist()
    across = np.array([-view.place(boss.axis)[1], view.place(boss.axis)[0]])
    across = across if across[1] > 0.0 or across[0] > 0.0 else -across
    ex, ey = (np.array([x, y]) + scale * boss.largest * across).tolist()
    tx, ty = ex + 3.0 * across[0] + 3.0, ey + 3.0 * across[1] + 3.0
    sheet.line("dimension", (ex, ey), (tx, ty))
    sheet.write(boss.label, tx + 0.5, ty - 0.5 * SMALL, SMALL)


def _dimension(
    sheet: Sheet, views: Sequence[View], corners: Sequence[Vector], scale: float, planes: Sequence[Flat]
) -> None:
    """Sizes over all, and coordinates of the flat faces from the part's origin."""
    front, above, side = views
    (low_x, low_z), (high_x, high_z) = (scale * b + corners[0] for b in front.bounds)
    (_, low_y), (_, high_y) = (scale * b + corners[1] for b in above.bounds)
    right = scale * side.bounds[1][0] + corners[2][0]
    size = [*(front.bounds[1] - front.bounds[0]), (above.bounds[1] - above.bounds[0])[1]]
    _linear(sheet, (low_x, high_z), (high_x, high_z), 9.0, size[0])
    _linear(sheet, (right, high_z), (right, low_z), 9.0, size[1])
    _linear(sheet, (high_x, high_y), (high_x, low_y), 9.0, size[2])
    _ordinates(sheet, [(v, scale * v + corners[0][0]) for v in _levels(planes, 0, front, 0)], low_z, along_x=True)
    _ordinates(sheet, [(v, scale * v + corners[0][1]) for v in _levels(planes, 2, front, 1)], low_x, along_x=False)
    _ordinates(sheet, [(v, scale * v + corners[1][1]) for v in _levels(planes, 1, above, 1)], low_x, along_x=False)


def _levels(planes: Sequence[Flat], axis: int, view: View, coordinate: int) -> list[float]:
    """Coordinates of the flat faces across an axis, of the outermost points, and of the origin."""
    large = planes[0].area * SHARE if planes else 0.0
    found = [
        float(np.sign(plane.normal[axis]) * plane.distance)
        for plane in planes
        if abs(abs(plane.normal[axis]) - 1.0) < ALIGNED and plane.area >= large
    ]
    ends = [float(view.bounds[k][coordinate]) for k in (0, 1)]
    inside = [0.0] if ends[0] <= 0.0 <= ends[1] else []
    return sorted({round(value, 4) + 0.0 for value in (*found, *ends, *inside)})


def _ordinates(sheet: Sheet, levels: Sequence[tuple[float, float]], edge: float, along_x: bool) -> None:
    """Coordinates beside a view, each at the end of a bent line; `levels`: value, place on the sheet."""
    places = _spread([place for _, place in levels], 3.4)
    for (value, place), label in zip(levels, places, strict=True):
        text = f"{round(value, 3) + 0.0:.7g}"
        points = [(place, edge - 1.0), (place, edge - 4.0), (label, edge - 8.0), (label, edge - 10.0)]
        if not along_x:
            points = [(y, x) for x, y in points]
        sheet.line("dimension", *points)
        x, y = points[-1]
        if along_x:
            sheet.write(text, x + 0.5 * SMALL, y - 1.0, SMALL, "right", 90.0)
        else:
            sheet.write(text, x - 1.0, y - 0.5 * SMALL, SMALL, "right")


def _spread(places: Sequence[float], gap: float) -> list[float]:
    """Ascending places moved apart to a smallest gap, as little as it takes."""
    groups: list[list[float]] = []  # first place, number of its labels
    wanted: list[list[float]] = []
    for place in places:
        groups.append([place, 1.0])
        wanted.append([place])
        while len(groups) > 1 and groups[-2][0] + groups[-2][1] * gap > groups[-1][0]:
            count = groups[-2][1] + groups[-1][1]
            members = wanted[-2] + wanted[-1]
            start = sum(one - k * gap for k, one in enumerate(members)) / count
            groups[-2:], wanted[-2:] = [[start, count]], [members]
    return [start + k * gap for start, count in groups for k in range(int(count))]


def _linear(sheet: Sheet, start: tuple[float, float], end: tuple[float, float], offset: float, value: float) -> None:
    """A dimension between two points, `offset` to the left of the way from the first to the second."""
    (x0, y0), (x1, y1) = start, end
    length = float(np.hypot(x1 - x0, y1 - y0))
    ux, uy = (x1 - x0) / length, (y1 - y0) / length
    nx, ny = -uy, ux
    for x, y in (start, end):
        sheet.line("dimension", (x + nx, y + ny), (x + (offset + 1.5) * nx, y + (offset + 1.5) * ny))
    a, b = ((x + offset * nx, y + offset * ny) for x, y in (start, end))
    sheet.line("dimension", a, b)
    outside = length < 8.0
    for (x, y), sign in ((a, -1.0), (b, 1.0)):
        sheet.arrow(x, y, *((-sign if outside else sign) * np.array([ux, uy])).tolist())
    degrees = 90.0 if abs(uy) > 0.5 else 0.0
    shift = 1.0 if degrees == 0.0 else (-1.0 if nx < 0.0 else 1.0)
    x, y = 0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])
    if degrees:
        sheet.write(f"{round(value, 3):.7g}", x + (shift if shift < 0 else 3.5), y, 2.5, "center", degrees)
    else:
        sheet.write(f"{round(value, 3):.7g}", x, y + shift, 2.5, "center")


def _tilts(sheet: Sheet, view: View, corner: Vector, scale: float, planes: Sequence[Flat]) -> None:
    """Angles of the large inclined faces that the front view sees on edge, against its horizontal."""
    seen: list[float] = []
    for plane in planes:
        flat = np.abs(plane.normal).max() > 1.0 - ALIGNED
        if flat or abs(plane.normal @ view.towards) > ALIGNED or plane.area < 0.25 * planes[0].area:
            continue
        along = np.cross(plane.normal, view.towards)
        angle = float(np.degrees(np.arctan2(*view.place(along)[::-1]))) % 180.0
        if any(abs(angle - other) < 1e-3 for other in seen):
            continue
        seen.append(angle)
        x, y = (scale * view.place(_middle(plane)) + corner).tolist()
        turn = np.radians(angle)
        tip = (x - 14.0 * np.sin(turn), y + 14.0 * np.cos(turn))
        sheet.line("dimension", (x, y), tip, (tip[0] - 12.0, tip[1]))
        sheet.arrow(x, y, x - tip[0], y - tip[1])
        sheet.write(f"{min(angle, 180.0 - angle):.6g}°", tip[0] - 11.5, tip[1] + 0.8, 2.5)


def _middle(plane: Flat) -> Vector:
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    properties = GProp_GProps()
    BRepGProp.SurfaceProperties_s(plane.face, properties)
    center = properties.CentreOfMass()
    return np.array([center.X(), center.Y(), center.Z()])


def _pictures(sheet: Sheet, brep: Brep, holes: Sequence[Bore], scale: float) -> float:
    """The part from a corner, and along bores that no other view shows round; returns the lowest y that they take."""
    pictures = [("", np.array([1.0, -1.0, 0.8]), np.array([1.0, 1.0, 0.0]), False)]
    for axis in _oblique(holes):
        right = np.cross([0.0, 1.0, 0.0], axis) if abs(axis[1]) < 0.9 else np.cross([1.0, 0.0, 0.0], axis)
        label = f"VIEW ALONG ({', '.join(f'{round(-v, 4) + 0.0:.4g}' for v in axis)})"
        pictures.append((label, axis, right, True))
    rooms, top = {1: [70.0], 2: [46.0, 84.0], 3: [38.0, 46.0, 46.0]}[len(pictures)], TOP - 2.0
    for (label, towards, right, looks_along), room in zip(pictures, rooms, strict=True):
        view = project(brep.shape, towards, right, hidden=False)
        low, high = view.bounds
        limit = min((RIGHT - COLUMN - 24.0) / (high - low)[0], (room - 14.0) / (high - low)[1])
        size = next((s for s in SCALES if s <= limit and s <= 2.0 * scale), limit)
        corner = np.array([0.5 * (COLUMN + RIGHT), top - 4.0 - 0.5 * (room - 10.0)]) - 0.5 * size * (low + high)
        shown = holes if looks_along else ()
        _draw_view(sheet, view, size, corner, shown)
        _number(sheet, view, size, corner, shown)
        if label:
            sheet.write(f"{label}  {_scale_words(size)}", 0.5 * (COLUMN + RIGHT), top - room + 3.0, SMALL, "center")
        top -= room
    return top


def _oblique(holes: Sequence[Bore]) -> list[Vector]:
    """Directions of bores that are none of the part's axes, towards the most mouths; at most two."""
    found: list[list[Vector]] = []
    for hole in holes:
        if np.abs(hole.axis).max() > 1.0 - ALIGNED:
            continue
        group = next((group for group in found if abs(abs(float(group[0] @ hole.axis)) - 1.0) < ALIGNED), None)
        if group is None:
            found.append([hole.axis])
        else:
            group.append(hole.axis)
    directions = []
    for group in found[:2]:
        agreeing = sum(1 for axis in group if float(axis @ group[0]) > 0.0)
        directions.append(group[0] if 2 * agreeing >= len(group) else -group[0])
    return directions


def _table(sheet: Sheet, holes: Sequence[Bore], top: float) -> None:
    """Bores and bosses: number, diameters with depths, where the axis leaves the part, its direction."""
    rows: list[tuple[str, ...]] = [("", "⌀ × length, from the mouth", "X", "Y", "Z", "axis")]
    for hole in holes:
        first, *others = hole.words
        rows.append((hole.label, first, *(f"{round(float(v), 3) + 0.0:.3f}" for v in hole.mouth), hole.direction))
        rows += [("", words, "", "", "", "") for words in others]
    space = int((top - 80.0) / ROW)
    left_out = max(0, len(rows) - space)
    if left_out:
        rows = [*rows[: space - 1], ("", f"and {left_out + 1} more: see the model", "", "", "", "")]
    columns = (COLUMN + 1.0, COLUMN + 9.0, COLUMN + 67.0, COLUMN + 81.0, COLUMN + 95.0, COLUMN + 98.0)
    anchors = ("left", "left", "right", "right", "right", "left")
    y = top - ROW
    for number, row in enumerate(rows):
        for text, x, anchor in zip(row, columns, anchors, strict=True):
            sheet.write(text, x, y + 1.2, SMALL, anchor)
        sheet.line("frame" if number == 0 else "dimension", (COLUMN, y), (RIGHT, y))
        y -= ROW
    sheet.rectangle("dimension", COLUMN, y + ROW, RIGHT, top)


def _notes(sheet: Sheet, caption: Caption) -> None:
    fits = ", ".join(f"⌀{diameter:g} {fit}" for diameter, fit in caption.fits)
    places = ", ".join(f"{face} {width:g}" for face, width in caption.positions)
    lines = (
        *([f"Fits of bores (ISO 286): {fits}."] if fits else []),
        *([f"Position against datum A, the largest named flat face: {places}."] if places else []),
        f"General tolerances {TOLERANCE}. Lengths in mm. Coordinates are those of the part's frame, as in the model.",
        f"What is not dimensioned is as in {caption.model or 'the model'}, revision {caption.revision or '-'}.",
        "Not stated by the design: threads, other fits, surface finish, edges, heat treatment, coating.",
    )
    for number, line in enumerate(lines):
        sheet.write(line, LEFT + 4.0, BOTTOM + 4.0 + 4.2 * (len(lines) - 1 - number), SMALL)


def _title_block(sheet: Sheet, caption: Caption, scale: float) -> None:
    sheet.rectangle("frame", LEFT, BOTTOM, RIGHT, TOP)
    sheet.rectangle("frame", COLUMN, BOTTOM, RIGHT, BOTTOM + 66.0)
    cells = (
        ("part", caption.title, 66.0, 54.0, 0.0, 1.0),
        ("material", f"{caption.material}, {caption.density:.6g} kg/m³", 54.0, 44.0, 0.0, 0.66),
        ("mass", f"{caption.mass:.4g} kg", 54.0, 44.0, 0.66, 1.0),
        ("design", caption.design or "-", 44.0, 34.0, 0.0, 1.0),
        ("revision", caption.revision or "-", 34.0, 24.0, 0.0, 0.5),
        ("model", caption.model or "-", 34.0, 24.0, 0.5, 1.0),
        ("scale", _scale_words(scale), 24.0, 14.0, 0.0, 0.25),
        ("quantity", str(caption.quantity), 24.0, 14.0, 0.25, 0.5),
        ("general tolerances", TOLERANCE, 24.0, 14.0, 0.5, 0.8),
        ("sheet", "1 / 1  A3", 14.0, 0.0, 0.5, 0.8),
        ("for", caption.organization or "-", 14.0, 0.0, 0.0, 0.5),
    )
    width = RIGHT - COLUMN
    for head, text, top, bottom, left, right in cells:
        x0, x1 = COLUMN + left * width, COLUMN + right * width
        sheet.rectangle("dimension", x0, BOTTOM + bottom, x1, BOTTOM + top)
        sheet.write(head, x0 + 1.0, BOTTOM + top - 2.4, 1.4)
        room = (x1 - x0 - 3.0) / max(1, len(text))
        sheet.write(text, x0 + 1.5, BOTTOM + bottom + 2.2, min(3.0, room / 0.85))
    _first_angle(sheet, COLUMN + 0.9 * width, BOTTOM + 12.0)


def _first_angle(sheet: Sheet, x: float, y: float) -> None:
    """The symbol of ISO 5456-2: a cone, its view from the left on its right."""
    sheet.line(
        "visible", (x - 9.0, y - 2.0), (x - 1.0, y - 4.0), (x - 1.0, y + 4.0), (x - 9.0, y + 2.0), (x - 9.0, y - 2.0)
    )
    turn = np.linspace(0.0, 2.0 * np.pi, 49)
    for radius in (2.0, 4.0):
        points = np.column_stack([x + 5.5 + radius * np.cos(turn), y + radius * np.sin(turn)])
        sheet.lines.append(Line(points, "visible", (x + 5.5, y, radius)))
    sheet.line("center", (x - 10.5, y), (x + 11.0, y))
    sheet.line("center", (x + 5.5, y - 5.5), (x + 5.5, y + 5.5))


def _scale_words(scale: float) -> str:
    return f"{scale:g} : 1" if scale >= 1.0 else f"1 : {1.0 / scale:.4g}"
