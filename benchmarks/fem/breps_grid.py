"""Builds both parts on their whole grids as exact solids and checks every one; prints the table kept in docs/parts.md.

python benchmarks/fem/breps_grid.py [every k-th design, 1 if omitted]

Checked: one solid, valid (BRepCheck), its volume against the extrapolated one of the meshes, no free-form face, as many
through bores as the part says.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Sequence

from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.GeomAbs import GeomAbs_SurfaceType
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopoDS import TopoDS
from parts_grid import BRACKETS, FOREARMS

from codesign.errors import GeometryError
from codesign.geometry.brep import Brep, build_brep, explore
from codesign.parts.bores import bores
from codesign.parts.part import Part
from codesign.studies.ironcub.bracket import JetpackBracket
from codesign.studies.ironcub.forearm import ForearmJetSupport

ANALYTIC = {
    GeomAbs_SurfaceType.GeomAbs_Plane,
    GeomAbs_SurfaceType.GeomAbs_Cylinder,
    GeomAbs_SurfaceType.GeomAbs_Cone,
    GeomAbs_SurfaceType.GeomAbs_Torus,
}
VOLUME = 1e-5  # relative; what the extrapolation of the meshes is good for


def faults(part: Part, brep: Brep) -> list[str]:
    """What is wrong with an exact solid, in words."""
    found = []
    volume = part.mass_properties().volume * 1e9
    if abs(brep.volume / volume - 1.0) > VOLUME:
        found.append(f"volume {brep.volume:.2f} instead of {volume:.2f} mm³")
    faces = explore(brep.shape, TopAbs_ShapeEnum.TopAbs_FACE)
    if any(BRepAdaptor_Surface(TopoDS.Face(face)).GetType() not in ANALYTIC for face in faces):
        found.append("a free-form face")
    through = sum(bore.through for bore in bores(brep) if bore.hollow)
    if through != part.through_holes():
        found.append(f"{through} through bores instead of {part.through_holes()}")
    return found


def sweep(name: str, designs: Sequence[tuple[float, float]], build: Callable[[float, float], Part]) -> int:
    """Prints a row and the faults; returns their number."""
    count, largest, wrong = 0, 0.0, 0
    for theta, part in parts(designs, build):
        count += 1
        try:
            brep = build_brep(part.shape())
        except GeometryError as error:
            wrong += 1
            print(name, theta, error)
            continue
        largest = max(largest, abs(brep.volume / (part.mass_properties().volume * 1e9) - 1.0))
        for words in faults(part, brep):
            wrong += 1
            print(name, theta, words)
    print(f"| {name} | {count} | {wrong} | {largest:.1e} |", flush=True)
    return wrong


def parts(
    designs: Iterable[tuple[float, float]], build: Callable[[float, float], Part]
) -> Iterable[tuple[tuple[float, float], Part]]:
    """Designs with their parts, one after the other."""
    return ((theta, build(*theta)) for theta in designs)


def main() -> int:
    step = int(sys.argv[1]) if len(sys.argv) > 1 else 1
    print("| exact solid | designs | faults | volume against the meshes, largest |")
    print("| --- | --- | --- | --- |")
    wrong = sweep("bracket", BRACKETS[::step], JetpackBracket)
    return min(1, wrong + sweep("forearm support", FOREARMS[::step], ForearmJetSupport))


if __name__ == "__main__":
    sys.exit(main())
