"""Clamps and loads of `codesign stress`: what each place caught, what is doubtful about it, why one is empty."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from codesign import fem
from codesign.cli.stress_options import AskedLoad, StressInputError
from codesign.fem.places import Caught, caught
from codesign.fem.selections import Box, Facing, Labeled, Place
from codesign.units import MILLIMETER


@dataclass(frozen=True)
class PlacedText:
    """A place as it was asked for: `text` of the option, the load on it, None for a clamp, and what a clamp holds."""

    text: str
    place: Place
    load: AskedLoad | None = None
    axes: str = "xyz"

    @property
    def kind(self) -> str:
        """Of option: clamp or load."""
        return "clamp" if self.load is None else "load"


@dataclass(frozen=True)
class CaughtPlace:
    """A place and the surface that it caught on the mesh."""

    asked: PlacedText
    selection: fem.Selection
    found: Caught

    def to_dict(self) -> dict[str, Any]:
        """For JSON, SI units."""
        load: dict[str, Any] = {"axes": self.asked.axes} if self.asked.load is None else {"force": self.force.tolist()}
        return {"kind": self.asked.kind, "selection": self.asked.text, **self.found.to_dict(), **load}

    @property
    def force(self) -> NDArray[np.float64]:
        """(3,) total force [N] of the load; zero for a clamp."""
        if self.asked.load is None:
            return np.zeros(3)
        return self.asked.load.resultant(self.found.area, self.found.normal)

    def words(self) -> str:
        """Place, kind and force, for notes in files: coordinates as in the option."""
        if self.asked.load is None:
            return f"held: {self.asked.text}"
        return f"load: {self.asked.text}, {self.asked.load.words()}"

    def warnings(self) -> list[str]:
        """What is doubtful, one text each."""
        return [f"{self.asked.kind} {self.asked.text} {doubt}" for doubt in self.found.warnings()]


def caught_places(asked: Sequence[PlacedText], named: Labeled, mesh: fem.TetMesh, size: float) -> list[CaughtPlace]:
    """What every place caught on a mesh of the edge length `size` [m].

    Raises: StressInputError: a place caught nothing; the message names it and says what to do.
    """
    places = []
    for placed, selection, facets in zip(asked, named.selections, named.masks, strict=True):
        found = caught(mesh, selection, named.surface, facets)
        if found is None:
            raise StressInputError(f"{placed.kind} {placed.text!r} {_why_empty(placed.place, named.surface, size)}")
        places.append(CaughtPlace(placed, selection, found))
    return places


def _why_empty(place: Place, surface: fem.SurfaceMesh, size: float) -> str:
    """The reason why a place caught nothing, and the remedy."""
    if isinstance(place, Facing):
        return f"selects nothing: no facet looks there within {place.angle:g}°; give a larger angle"
    lower, upper = surface.points.min(axis=0), surface.points.max(axis=0)
    if isinstance(place, Box) and (np.any(place.lower > upper) or np.any(place.upper < lower)):
        corners = ", ".join(f"{x / MILLIMETER:.4g}" for x in (*lower, *upper))
        return f"selects nothing: the box lies outside of the part, which fills {corners} mm"
    return (
        "selects nothing: the box holds no whole facet of the surface and no whole side of an element, it is smaller "
        f"than the elements (edge length {size / MILLIMETER:.3g} mm); enlarge the box or give a smaller --edge-length"
    )
