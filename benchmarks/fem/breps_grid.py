"""Builds both parts on their whole grids as exact solids and checks every one; prints the table kept in docs/parts.md.

python benchmarks/fem/breps_grid.py [every k-th design, 1 if omitted] [log]

Checked: one solid, valid (BRepCheck), its volume against the extrapolated one of the meshes, no free-form face, as many
through bores as the part says. Counted: faces by kind; fillets are tori and cylinders that do not go round.
log: gets a line for each design (JSON); designs that it names are not built again.
"""

from __future__ import annotations

import json
import sys
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.GeomAbs import GeomAbs_SurfaceType
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopoDS import TopoDS
from parts_grid import BRACKETS, FOREARMS

from codesign.errors import GeometryError
from codesign.geometry.brep import Brep, build_brep, explore
from codesign.geometry.features import cylinders
from codesign.parts.bores import bores
from codesign.parts.part import Part
from codesign.studies.ironcub.bracket import JetpackBracket
from codesign.studies.ironcub.forearm import ForearmJetSupport

ANALYTIC = {
    GeomAbs_SurfaceType.GeomAbs_Plane: "planes",
    GeomAbs_SurfaceType.GeomAbs_Cylinder: "cylinders",
    GeomAbs_SurfaceType.GeomAbs_Cone: "cones",
    GeomAbs_SurfaceType.GeomAbs_Torus: "tori",
}
FREE = "free-form faces"
VOLUME = 1e-5  # relative; what the extrapolation of the meshes is good for


def faces_of(brep: Brep) -> Counter[str]:
    """Faces of a solid by kind; cylinders that go round count apart."""
    faces = explore(brep.shape, TopAbs_ShapeEnum.TopAbs_FACE)
    kinds = Counter(ANALYTIC.get(BRepAdaptor_Surface(TopoDS.Face(face)).GetType(), FREE) for face in faces)
    kinds["round"] = len(cylinders(brep))
    return kinds


def checked(part: Part) -> dict[str, Any]:
    """What an exact solid is, and in `faults` what is wrong with it, in words."""
    try:
        brep = build_brep(part.shape())
    except GeometryError as error:
        return {"faults": [str(error)]}
    difference = brep.volume / (part.mass_properties().volume * 1e9) - 1.0
    faces, found = faces_of(brep), []
    if abs(difference) > VOLUME:
        found.append(f"volume {difference:.1e} off")
    if faces[FREE]:
        found.append(f"{faces[FREE]} {FREE}")
    through = sum(bore.through for bore in bores(brep) if bore.hollow)
    if through != part.through_holes():
        found.append(f"{through} through bores instead of {part.through_holes()}")
    return {"volume": difference, "faces": dict(sorted(faces.items())), "faults": found}


def sweep(
    name: str, designs: Sequence[tuple[float, float]], build: Callable[[float, float], Part], log: Path | None
) -> int:
    """Prints a row, the faults, and where the number of faces changes; returns the number of faults."""
    lines = [] if log is None or not log.exists() else [json.loads(line) for line in log.read_text().splitlines()]
    known = {tuple(line["design"]): line for line in lines if line["part"] == name}
    counts: Counter[str] = Counter()
    wrong, largest = 0, 0.0
    for theta in designs:
        result = known.get(theta)
        if result is None:
            result = {"part": name, "design": theta, **checked(build(*theta))}
            if log is not None:
                with log.open("a") as file:
                    file.write(json.dumps(result) + "\n")
        largest = max(largest, abs(result.get("volume", 0.0)))
        counts[", ".join(f"{count} {kind}" for kind, count in result.get("faces", {}).items())] += 1
        for words in result["faults"]:
            wrong += 1
            print(name, theta, words)
    kinds = "; ".join(f"{words} ({count})" for words, count in counts.most_common())
    print(f"| {name} | {len(designs)} | {wrong} | {largest:.1e} | {kinds} |", flush=True)
    return wrong


def main() -> int:
    step = int(sys.argv[1]) if len(sys.argv) > 1 else 1
    log = Path(sys.argv[2]) if len(sys.argv) > 2 else None
    print("| exact solid | designs | faults | volume against the meshes, largest | faces (designs) |")
    print("| --- | --- | --- | --- | --- |")
    wrong = sweep("bracket", BRACKETS[::step], JetpackBracket, log)
    return min(1, wrong + sweep("forearm support", FOREARMS[::step], ForearmJetSupport, log))


if __name__ == "__main__":
    sys.exit(main())
