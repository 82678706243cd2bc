"""Buckling factors of the shipped parts, and of the forearm supports against CalculiX; tables of docs/fem.md.

python benchmarks/fem/buckling.py

The second table needs `ccx` (Debian calculix-ccx) and gmsh, as `fem_vs_calculix.py` does; it is left out without them.
"""

from __future__ import annotations

import math
import re
import shutil
import tempfile
import time
from dataclasses import replace
from pathlib import Path

import codesign
from codesign import _core, fem
from codesign.chain.chain import stress_settings
from codesign.parts.load_case import StressSettings, part_case
from codesign.parts.part import Part

DESIGNS = (
    {"angle": 15, "distance": 42, "offset": 80, "length": 108},
    {"angle": 60, "distance": 60, "offset": 100, "length": 150},
)


def analyze(part: Part, settings: StressSettings, count: int) -> tuple[_core.PartAnalysis, float]:
    """Result and CPU seconds."""
    case = part_case(part, settings)
    case.buckling = count
    start = time.process_time()
    analysis = _core.analyze_part(case)
    return analysis, time.process_time() - start


def words(factor: float) -> str:
    """A factor for the table."""
    return f"{factor:.1f}" if math.isfinite(factor) else "none"


def calculix_factors(mesh: fem.TetMesh, case: _core.PartCase, count: int) -> list[float]:
    """The same with CalculiX: C3D10, nodal forces of this project."""
    from fem_vs_calculix import run_deck, write_deck

    with tempfile.TemporaryDirectory() as folder:
        write_deck(Path(folder) / "part.inp", mesh, case, ["*BUCKLE", str(count)], [])
        run_deck(folder)
        text = (Path(folder) / "part.dat").read_text()
    return [float(found) for found in re.findall(r"^ +\d+ +(\S+)$", text, re.MULTILINE)]


def own_factors() -> None:
    """The first table."""
    study = codesign.load_study("ironcub_paper")
    print("| part | mesh | tetrahedra | first two factors | CPU s without | with one |")
    print("| --- | --- | --- | --- | --- | --- |")
    for design in DESIGNS:
        for name, part in study.build_parts(design).items():
            for accuracy in ("optimization", "fine"):
                settings = replace(stress_settings(study.config, name), accuracy=accuracy)
                (plain, without), (_, one) = (analyze(part, settings, count) for count in (0, 1))
                factors = analyze(part, settings, 2)[0].buckling_factors
                print(
                    f"| {part.title} | {accuracy} | {len(plain.mesh.tets)} | {', '.join(map(words, factors))} "
                    f"| {without:.1f} | {one:.1f} |",
                    flush=True,
                )


def against_calculix() -> None:
    """The second table: meshes with straight and curved elements, which CalculiX integrates with four points."""
    study = codesign.load_study("ironcub_paper")
    print("| part | elements | codesign | CalculiX |\n| --- | --- | --- | --- |")
    for design in DESIGNS:
        part = study.build_parts(design)["forearm_support"]
        case = part_case(part, stress_settings(study.config, part.name))
        for elements in ("straight", "curved"):
            mesh = fem.tetrahedralize(case.surface, case.size, facet_angle_deg=20.0, curved=elements == "curved")
            system = _core.fem.StaticSystem(mesh, case.material, case.supports, case.settings)
            here = system.buckling_modes(system.displacement(case.cases[0].loads), 2).factor
            there = calculix_factors(mesh, case, 2)
            numbers = " | ".join(", ".join(f"{factor:.7g}" for factor in both) for both in (here, there))
            print(f"| {part.title} | {elements} | {numbers} |", flush=True)


def main() -> None:
    own_factors()
    if shutil.which("ccx"):
        print()
        against_calculix()


if __name__ == "__main__":
    main()
