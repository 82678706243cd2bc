"""Seeded plates with pockets, ribs, cups, bosses, holes, fillets, thin lips and cavities, as closed surfaces.

Lengths in millimeters until `surface`, which gives meters. Every part is one solid; nothing of it is thinner than the
wall that was drawn for it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import manifold3d
import numpy as np

from codesign import fem
from codesign.units import MILLIMETER

Solid = manifold3d.Manifold
CHORDS = 32  # on a full circle


@dataclass(frozen=True, slots=True)
class GeneratedPart:
    """A part that stands on z = 0, what it is made of, and its thinnest wall [mm]."""

    name: str
    wall: float
    solid: Solid

    def surface(self) -> fem.SurfaceMesh:
        """In meters."""
        mesh = self.solid.to_mesh()
        points = np.asarray(mesh.vert_properties)[:, :3].astype(float) * MILLIMETER
        return fem.SurfaceMesh(points, np.asarray(mesh.tri_verts).astype(np.int32))


def box(x0: float, y0: float, z0: float, x1: float, y1: float, z1: float) -> Solid:
    """An axis-parallel box between two corners."""
    return Solid.cube((x1 - x0, y1 - y0, z1 - z0)).translate((x0, y0, z0))


def cylinder(x: float, y: float, z: float, radius: float, height: float) -> Solid:
    """An upright cylinder on a center."""
    return Solid.cylinder(height, radius, radius, CHORDS).translate((x, y, z))


def lying_cylinder(y: float, z: float, radius: float, length: float) -> Solid:
    """A cylinder along x, longer than the part on both sides."""
    rod = Solid.cylinder(length + 2.0, radius, radius, CHORDS).rotate((0.0, 90.0, 0.0))
    return rod.translate((-1.0, y, z))


@dataclass(slots=True)
class Draft:
    """A plate of `length` x `width` x `height` that features are put on; `wall` is the one that thin features get."""

    rng: np.random.Generator
    length: float
    width: float
    height: float
    wall: float
    solid: Solid

    def inner_box(self, margin: float) -> tuple[float, float, float, float]:
        """Of a random rectangle in the plan, at least `margin` inside."""
        x0 = self.rng.uniform(margin, 0.4 * self.length)
        y0 = self.rng.uniform(margin, 0.4 * self.width)
        x1 = self.rng.uniform(0.6 * self.length, self.length - margin)
        y1 = self.rng.uniform(0.6 * self.width, self.width - margin)
        return x0, y0, x1, y1


def pocket(draft: Draft) -> None:
    """From above, down to a floor of the wall."""
    x0, y0, x1, y1 = draft.inner_box(max(2.0, draft.wall))
    draft.solid -= box(x0, y0, draft.wall, x1, y1, draft.height + 1.0)


def edge_pocket(draft: Draft) -> None:
    """From above, leaving the wall to one side of the plate."""
    x0, _, x1, y1 = draft.inner_box(3.0)
    depth = draft.rng.uniform(0.4, 0.7) * draft.height
    draft.solid -= box(x0, draft.wall, draft.height - depth, x1, y1, draft.height + 1.0)


def fillet_pocket(draft: Draft) -> None:
    """A pocket with a rounded trough as floor, down to the wall."""
    radius = draft.rng.uniform(0.3, 0.45) * min(draft.width, 2.0 * (draft.height - draft.wall))
    draft.solid -= lying_cylinder(0.5 * draft.width, draft.wall + radius, radius, draft.length)
    draft.solid -= box(
        -1.0, 0.5 * draft.width - radius, draft.wall + radius, draft.length + 1.0, 0.5 * draft.width + radius, 1e3
    )


def rib(draft: Draft) -> None:
    """As thick as the wall, standing on the plate."""
    x = draft.rng.uniform(0.2, 0.8) * draft.length
    margin = draft.rng.choice([0.0, 3.0])
    top = draft.height + draft.rng.uniform(4.0, 10.0)
    draft.solid += box(x, margin, 0.0, x + draft.wall, draft.width - margin, top)


def cup(draft: Draft) -> None:
    """A tube with the wall, standing on the plate and open above, bored down to the same wall."""
    radius = draft.rng.uniform(4.0, 0.25 * draft.width)
    x, y = 0.5 * draft.length, 0.5 * draft.width
    top = draft.height + draft.rng.uniform(4.0, 10.0)
    draft.solid += cylinder(x, y, 0.0, radius + draft.wall, top)
    draft.solid -= cylinder(x, y, draft.wall, radius, top)


def boss(draft: Draft) -> None:
    """A solid stud."""
    radius = draft.rng.uniform(2.0, 5.0)
    x = draft.rng.uniform(radius + 1.0, draft.length - radius - 1.0)
    y = draft.rng.uniform(radius + 1.0, draft.width - radius - 1.0)
    draft.solid += cylinder(x, y, 0.0, radius, draft.height + draft.rng.uniform(3.0, 8.0))


def cross_hole(draft: Draft) -> None:
    """Along the plate, the wall above its base."""
    radius = draft.rng.uniform(0.5, 0.5 * max(1.1, draft.height - 2.0 * draft.wall))
    radius = min(radius, 0.5 * (draft.height - 2.0 * draft.wall))
    if radius < 0.4:
        return
    draft.solid -= lying_cylinder(draft.rng.uniform(0.3, 0.7) * draft.width, draft.wall + radius, radius, draft.length)


def through_holes(draft: Draft) -> None:
    """One to three upright ones."""
    for _ in range(draft.rng.integers(1, 4)):
        radius = draft.rng.uniform(1.0, 4.0)
        x = draft.rng.uniform(radius + 2.0, draft.length - radius - 2.0)
        y = draft.rng.uniform(radius + 2.0, draft.width - radius - 2.0)
        draft.solid -= cylinder(x, y, -1.0, radius, 1e3)


def lip(draft: Draft) -> None:
    """A thin flange beyond one end."""
    reach = draft.rng.uniform(3.0, 10.0)
    z = draft.rng.choice([0.0, 0.5 * (draft.height - draft.wall)])
    draft.solid += box(draft.length - 0.5, 0.0, z, draft.length + reach, draft.width, z + draft.wall)


def cavity(draft: Draft) -> None:
    """Closed on all sides, the wall above its base."""
    x0, y0, x1, y1 = draft.inner_box(max(2.0, draft.wall))
    top = draft.height - draft.wall
    if top > draft.wall + 0.5:
        draft.solid -= box(x0, y0, draft.wall, x1, y1, top)


Features = dict[str, Callable[[Draft], None]]
FEATURES: Features = {
    f.__name__: f for f in (pocket, edge_pocket, fillet_pocket, rib, cup, boss, cross_hole, through_holes, lip, cavity)
}


def generate(seed: int) -> GeneratedPart:
    """The part of a seed: a plate with one to three kinds of features. Seeds whose features cut it apart move on."""
    rng = np.random.default_rng([seed, 20])
    while True:
        length, width, height = rng.uniform(30.0, 60.0), rng.uniform(25.0, 40.0), rng.uniform(4.0, 10.0)
        wall = float(np.exp(rng.uniform(np.log(0.5), np.log(5.0))))
        wall = min(wall, 0.5 * height)
        part = featured_plate(rng, FEATURES, length, width, height, wall)
        if is_one_solid(part.solid):
            return part


def featured_plate(
    rng: np.random.Generator, features: Features, length: float, width: float, height: float, wall: float
) -> GeneratedPart:
    """A plate [mm] with one to three kinds of features; they may have cut it in pieces."""
    draft = Draft(rng, length, width, height, wall, box(0.0, 0.0, 0.0, length, width, height))
    names = rng.choice(list(features), size=rng.integers(1, 4), replace=False)
    for name in names:
        features[name](draft)
    return GeneratedPart("+".join(names), wall, draft.solid)


def is_one_solid(solid: Solid) -> bool:
    """Whether one outer shell bounds it, however many cavities it has."""
    return sum(piece.volume() > 0.0 for piece in solid.decompose()) == 1
