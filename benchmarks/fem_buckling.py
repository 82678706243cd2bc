"""Buckling factors of the shipped parts, on the mesh of the optimisation and on the fine one; table of docs/fem.md.

python benchmarks/fem_buckling.py
"""

from __future__ import annotations

import math
import time
from dataclasses import replace

import codesign
from codesign import _core
from codesign.analysis import StressSettings, part_case
from codesign.geometry.part import Part
from codesign.pipeline import stress_settings

DESIGNS = (
    {"angle": 15, "distance": 42, "offset": 80, "length": 108},
    {"angle": 60, "distance": 60, "offset": 100, "length": 150},
)


def analyse(part: Part, settings: StressSettings, count: int) -> tuple[_core.PartAnalysis, float]:
    """Result and CPU seconds."""
    case = part_case(part, settings)
    case.buckling = count
    start = time.process_time()
    analysis = _core.analyse_part(case)
    return analysis, time.process_time() - start


def words(factor: float) -> str:
    """A factor for the table."""
    return f"{factor:.1f}" if math.isfinite(factor) else "none"


def main() -> None:
    study = codesign.load_study("ironcub")
    print("| part | mesh | tetrahedra | first two factors | CPU s without | with one |")
    print("| --- | --- | --- | --- | --- | --- |")
    for design in DESIGNS:
        for name, part in study.build_parts(design).items():
            for accuracy in ("optimisation", "fine"):
                settings = replace(stress_settings(study.config, name), accuracy=accuracy)
                (plain, without), (_, one) = (analyse(part, settings, count) for count in (0, 1))
                factors = analyse(part, settings, 2)[0].buckling_factors
                print(
                    f"| {part.title} | {accuracy} | {len(plain.mesh.tets)} | {', '.join(map(words, factors))} "
                    f"| {without:.1f} | {one:.1f} |",
                    flush=True,
                )


if __name__ == "__main__":
    main()
