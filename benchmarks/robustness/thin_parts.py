"""A series of trays, cups, ribs, pockets and wedges, and seeded plates, with thin walls. Lengths in millimeters."""

from __future__ import annotations

import manifold3d
import numpy as np
from generated_parts import (
    Draft,
    Features,
    GeneratedPart,
    box,
    cavity,
    cross_hole,
    cup,
    cylinder,
    featured_plate,
    is_one_solid,
    pocket,
    rib,
)

WALLS = (0.6, 1.0, 1.5, 2.0, 3.0)
WEDGE_ANGLES = (20.0, 10.0, 5.0, 3.0, 2.0)  # degrees
ROUND = (
    "cup",
    "cross_hole",
    "through_holes",
    "boss",
    "fillet_pocket",
)  # features whose volume depends on how chords are cut


def tray(draft: Draft) -> None:
    """A pocket over nearly the whole plan, down to a floor of the wall, between rims of the wall or more."""
    rim = draft.rng.uniform(draft.wall, 6.0)
    draft.solid -= box(rim, rim, draft.wall, draft.length - rim, draft.width - rim, draft.height + 1.0)


FEATURES: Features = {f.__name__: f for f in (tray, pocket, rib, cup, cavity, cross_hole)}


def thin_plate(seed: int) -> GeneratedPart:
    """A plate with one to three kinds of features and walls of 0.6 to 3 mm."""
    rng = np.random.default_rng([seed, 60])
    while True:
        length, width, height = rng.uniform(30.0, 60.0), rng.uniform(25.0, 40.0), rng.uniform(6.5, 12.0)
        wall = float(np.exp(rng.uniform(np.log(0.6), np.log(3.0))))
        part = featured_plate(rng, FEATURES, length, width, height, wall)
        if is_one_solid(part.solid):
            return part


def wedge(angle_deg: float) -> GeneratedPart:
    """60 x 20 mm in the plan, thick at x = 0, with an edge of this angle at its other end."""
    height = 60.0 * np.tan(np.radians(angle_deg))
    corners = [(x, y, z) for y in (0.0, 20.0) for x, z in ((0.0, 0.0), (0.0, height), (60.0, height))]
    return GeneratedPart(f"wedge {angle_deg:g} deg", 0.0, manifold3d.Manifold.hull_points(np.array(corners)))


def series() -> list[GeneratedPart]:
    """Each kind with each wall, on bodies of 60 mm; wedges of each angle."""
    parts = []
    for w in WALLS:
        plate = box(0, 0, 0, 60, 60, 8)
        shapes = {
            "tray": plate - box(8, 8, w, 52, 52, 9),
            "pocket": box(0, 0, 0, 60, 40, 10) - box(20, 10, w, 40, 30, 11),
            "rib": box(0, 0, 0, 60, 20, 6) + box(30, 0, 0, 30 + w, 20, 20),
            "cup": plate + cylinder(30, 30, 0, 12 + w, 20) - cylinder(30, 30, w, 12, 21),
        }
        parts += [GeneratedPart(f"{name} {w:g}", w, solid) for name, solid in shapes.items()]
    return parts + [wedge(angle) for angle in WEDGE_ANGLES]
