"""Effect of the study's options, of simplified parts and of the sizes of the mesh on the stress; tables of docs/fem.md.

python benchmarks/fem/options.py
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import codesign
from codesign import _core, fem
from codesign.chain.chain import stress_settings
from codesign.parts.load_case import StressSettings, part_case
from codesign.parts.part import Part
from codesign.parts.strength import confirm, part_document

DESIGNS = (
    {"angle": 15, "distance": 42, "offset": 80, "length": 108},
    {"angle": 60, "distance": 60, "offset": 100, "length": 150},
)
OPTIONS: dict[str, dict[str, Any]] = {
    "as published": {},
    "thrust_line": {"load": "thrust_line"},
    "bolted": {"support": "bolted"},
    "both": {"load": "thrust_line", "support": "bolted"},
}
OFFSETS, LENGTHS = (80, 90, 100, 110, 120), (50, 100, 150)
TITANIUM_YIELD = 880e6  # Pa, Ti-6Al-4V; the stress of a clamped part under a given force does not ask for its modulus
SIZES = (1.25, 1.0, 0.8)
MEGA, MILLI = 1e6, 1e-3


def analyze(part: Part, settings: StressSettings) -> tuple[_core.PartAnalysis, float]:
    """Result and CPU seconds."""
    start = time.process_time()
    analysis = _core.analyze_part(part_case(part, settings))
    return analysis, time.process_time() - start


def options(part: Part, settings: StressSettings) -> None:
    """One row an option; the forearm support has no other support."""
    for name, change in OPTIONS.items():
        if part.name == "forearm_support" and "support" in change:
            continue
        result = analyze(part, replace(settings, **change))[0].result
        print(
            f"| {part.title} | {name} | {result.safety_factor:.1f} | {result.peak_stress / MEGA:.2f} "
            f"| {result.stress_50 / MEGA:.2f} | {result.max_displacement / MILLI:.4f} |",
            flush=True,
        )


def print_geometry(part: Part, name: str, document: Mapping[str, Any], mass: float, seconds: float) -> None:
    """One row of the second table."""
    print(
        f"| {part.title} | {name} | {mass:.4f} | {document['peak_stress'] / MEGA:.2f} ± "
        f"{document['stress_error'] / MEGA:.2f} | {document['stress_50'] / MEGA:.2f} "
        f"| {document['max_displacement'] / MILLI:.4f} | {document['tetrahedra']} | {seconds:.1f} |",
        flush=True,
    )


def geometries(part: Part, settings: StressSettings) -> None:
    """Simplified and full part on the mesh of the optimization, and the full part as confirmed."""
    mass = part.mass_properties()
    for geometry in ("simplified", "full"):
        analysis, seconds = analyze(part, replace(settings, geometry=geometry))
        copies = 2 if part.name == "jetpack_bracket" else 1
        meshed = copies * analysis.mesh.quality.volume * part.density
        print_geometry(part, geometry, part_document(mass, analysis), meshed, seconds)
    start = time.process_time()
    confirmed = confirm(part, settings).confirmed
    seconds = time.process_time() - start
    print_geometry(part, f"full, fine, refined {confirmed['refinements']} ×", confirmed, mass.mass, seconds)


def thrust_lines(study: codesign.Study) -> None:
    """Safety factors of forearm supports under a thrust on the turbine's axis, in two materials."""
    settings = replace(stress_settings(study.config, "forearm_support"), load="thrust_line")
    for offset in OFFSETS:
        peaks = []
        for length in LENGTHS:
            part = study.build_parts({**DESIGNS[0], "offset": offset, "length": length})["forearm_support"]
            peaks.append(analyze(part, settings)[0].result.peak_stress)
        for yield_strength in (settings.material.yield_strength, TITANIUM_YIELD):
            factors = " | ".join(f"{yield_strength / peak:.1f}" for peak in peaks)
            print(f"| {offset} | {yield_strength / MEGA:.0f} | {factors} |", flush=True)


def mesh_sizes(part: Part, settings: StressSettings) -> None:
    """Stress on meshes whose sizes are all multiplied by the same number."""
    results = []
    for scale in SIZES:
        case = part_case(part, settings)
        sources = [fem.SizeSource(s.points, scale * s.size, s.growth, s.radius) for s in case.size.sources]
        case.size = fem.SizeField(scale * case.size.base, sources)
        results.append(_core.analyze_part(case).result)
    cells = [
        f"{value / MEGA:.2f}" for name in ("stress_50", "peak_stress") for value in (getattr(r, name) for r in results)
    ]
    print(f"| {part.title} | {' | '.join(cells)} |", flush=True)


def main() -> None:
    study = codesign.load_study("ironcub_paper")
    parts = [
        (part, stress_settings(study.config, name)) for d in DESIGNS for name, part in study.build_parts(d).items()
    ]
    print("| part | option | safety factor | peak, MPa | σ_50, MPa | largest u, mm |")
    print("| --- | --- | --- | --- | --- | --- |")
    for part, settings in parts:
        options(part, settings)
    print("\n| part | geometry | mass, kg | peak, MPa | σ_50, MPa | largest u, mm | tetrahedra | CPU s |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for part, settings in parts:
        geometries(part, settings)
    print("\n| offset, mm | yield, MPa | " + " | ".join(f"length {length} mm" for length in LENGTHS) + " |")
    print("| --- | --- | --- | --- | --- |")
    thrust_lines(study)
    titles = [f"{name} × {scale:g}" for name in ("σ_50", "peak") for scale in SIZES]
    print(f"\n| part | {' | '.join(titles)} |\n| --- |" + " --- |" * len(titles))
    for part, settings in parts:
        mesh_sizes(part, settings)


if __name__ == "__main__":
    main()
