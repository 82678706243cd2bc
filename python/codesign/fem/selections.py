"""Places on the surface of a file for supports and loads; their borders become lines of the mesh."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from codesign import fem
from codesign._core import fem as _core
from codesign.errors import MeshError, ModelError
from codesign.fem.cut import cut_by_box
from codesign.fem.holes import Cylinder, holes, hollows
from codesign.fem.model import MAX_BEND_DEG
from codesign.names import nearest
from codesign.units import MILLIMETER

MOST_FACES = 12  # in a message
SAME_RADIUS = 0.01  # relative

Triangles = NDArray[np.bool_]  # (m,) of the surface: selected or not


@dataclass(frozen=True)
class Near:
    """The smooth face nearest to a point [m]: it ends where the surface leaves its plane, cylinder, cone or sphere."""

    point: tuple[float, float, float]

    def triangles(self, surface: fem.SurfaceMesh) -> Triangles:
        """Those of the surface."""
        chosen = np.zeros(len(surface.triangles), dtype=bool)
        start = _core.nearest_triangle(surface, np.array(self.point))
        chosen[_core.smooth_patch(surface, start, np.radians(MAX_BEND_DEG)).triangles] = True
        return chosen

    def on_mesh(self) -> fem.Selection:
        """Sides of elements, where the surface's triangles do not tell."""
        return fem.faces_near(self.point, MAX_BEND_DEG)


@dataclass(frozen=True)
class Box:
    """What lies in a box [m]: triangles of the surface and sides of elements."""

    lower: tuple[float, float, float]
    upper: tuple[float, float, float]

    def triangles(self, surface: fem.SurfaceMesh) -> Triangles:
        """Those of the surface."""
        inside = np.all((surface.points >= self.lower) & (surface.points <= self.upper), axis=1)
        chosen: Triangles = inside[surface.triangles].all(axis=1)
        return chosen

    def on_mesh(self) -> fem.Selection:
        """Sides of elements."""
        return fem.faces_in_box(self.lower, self.upper)


@dataclass(frozen=True)
class Facing:
    """What looks in a direction within an angle [deg]."""

    normal: tuple[float, float, float]
    angle: float

    def triangles(self, surface: fem.SurfaceMesh) -> Triangles:
        """Those of the surface."""
        a, b, c = (surface.points[surface.triangles[:, k]] for k in range(3))
        normals = np.cross(b - a, c - a)
        cosine = normals @ np.asarray(self.normal) / np.linalg.norm(self.normal)
        chosen: Triangles = cosine >= np.cos(np.radians(self.angle)) * np.linalg.norm(normals, axis=1)
        return chosen

    def on_mesh(self) -> fem.Selection:
        """Sides of elements, where the surface's triangles do not tell."""
        return fem.faces_with_normal(self.normal, self.angle)


@dataclass(frozen=True)
class NamedFace:
    """A face by its name in the file, or `face N` by its number."""

    name: str

    def triangles(self, surface: fem.SurfaceMesh) -> Triangles:
        """Those of the surface. Raises: ModelError: there is no such face."""
        names = list(surface.face_names)
        if self.name not in names:
            known = [name for name in names if name]
            if not known:
                hint = "the file names none: choose by near:, box:, normal: or hole:"
            elif self.name.removeprefix("face ").isdecimal():
                hint = f"there are {', '.join(known[:MOST_FACES])}{' …' if len(known) > MOST_FACES else ''}"
            else:
                hint = nearest(self.name, known)
            raise ModelError(f"no face {self.name!r}; {hint}; `codesign faces FILE` lists those of a STEP file")
        chosen: Triangles = np.asarray(surface.face) == names.index(self.name)
        return chosen

    def on_mesh(self) -> fem.Selection:
        """Sides of elements of a mesh of the surface with its own faces."""
        return fem.select_names(self.name)


@dataclass(frozen=True)
class Holes:
    """The walls of all round holes of a radius [m]; round faces that do not close, fillets say, are none."""

    radius: float

    def triangles(self, surface: fem.SurfaceMesh) -> Triangles:
        """Those of the surface. Raises: ModelError: there is no such hole."""
        found = holes(surface)
        chosen = self._of_radius(found)
        if not chosen:
            radii = sorted({f"{hole.radius / MILLIMETER:.4g}" for hole in found.values()})
            known = f"the holes have radii of {', '.join(radii)} mm" if radii else "there is no round hole"
            if self._of_radius(hollows(surface)):
                known += "; a round face of this radius does not close (a fillet, a slot): choose it by near: or face:"
            raise ModelError(f"no hole of radius {self.radius / MILLIMETER:g} mm; {known}")
        facets: Triangles = np.isin(np.asarray(surface.face), chosen)
        return facets

    def _of_radius(self, round_faces: Mapping[int, Cylinder]) -> list[int]:
        return [i for i, wall in round_faces.items() if abs(wall.radius - self.radius) <= SAME_RADIUS * self.radius]

    def on_mesh(self) -> fem.Selection:
        """Sides of elements whose middle lies on the walls: known only from the surface."""
        raise MeshError("the borders of the holes are too ragged for this edge length: choose a smaller one")


Place = Near | Box | Facing | NamedFace | Holes


@dataclass(frozen=True)
class Labeled:
    """A surface with a named face for each place (and each overlap), and the places as selections of its mesh.

    masks: (m,) of each place, which triangles of the surface belong to it. ragged: why the borders of the places could
    not be lines of the mesh, so that whole sides of elements are selected; empty if they are.
    """

    surface: fem.SurfaceMesh
    selections: list[fem.Selection]
    masks: list[Triangles]
    ragged: str = ""


def label_surface(surface: fem.SurfaceMesh, places: Sequence[Place]) -> Labeled:
    """Names the places on a surface.

    A box that holds no whole triangle cuts those that it meets. One that holds some also takes sides of elements that
    it holds although it cuts the triangle of the surface they lie on.
    """
    cutting = [place for place in places if isinstance(place, Box) and not place.triangles(surface).any()]
    for box in cutting:
        surface = cut_by_box(surface, box.lower, box.upper)
    masks = np.array([place.triangles(surface) for place in places])
    kinds, face = np.unique(masks, axis=1, return_inverse=True)
    names = [f"region {i}" if kind.any() else "" for i, kind in enumerate(kinds.T)]
    labeled = fem.SurfaceMesh(surface.points, surface.triangles, face.ravel().tolist(), names)
    selections = []
    for place, kind in zip(places, kinds, strict=True):
        parts: list[str | fem.Selection] = [name for name, chosen in zip(names, kind, strict=True) if chosen]
        if isinstance(place, Box) or not parts:
            parts.append(place.on_mesh())
        selections.append(fem.select_union(*parts))
    return Labeled(labeled, selections, list(masks))
