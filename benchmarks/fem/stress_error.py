"""Error estimate of the peak stress against the true error, on designs spread over the grid; table of docs/fem.md.

python benchmarks/fem/stress_error.py [every k-th design, 1 if omitted] [factor on the analyzed edge lengths]

True error: difference from the fine mesh with half its edge length around the peak.
"""

from __future__ import annotations

import sys
import time
from dataclasses import replace

import codesign
from codesign import _core, fem
from codesign.chain.chain import stress_settings
from codesign.parts.load_case import StressSettings
from codesign.parts.part import Part
from codesign.studies.ironcub.bracket import JetpackBracket
from codesign.studies.ironcub.forearm import ForearmJetSupport

BRACKETS = [
    (1, 48),
    (10, 100),
    (15, 42),
    (25, 80),
    (33, 40),
    (40, 60),
    (60, 60),
    (79, 100),
]  # angle [deg], distance [mm]
FOREARMS = [
    (80, 50),
    (80, 108),
    (88, 50),
    (94, 130),
    (100, 150),
    (110, 50),
    (120, 100),
    (120, 150),
]  # offset, length [mm]
MEGA = 1e6


def reference(part: Part, settings: StressSettings) -> _core.PartAnalysis:
    """On the fine mesh, halved around the peak whatever its estimate."""
    case = part.stress_case(replace(settings, accuracy="fine"))  # type: ignore[attr-defined]
    case.tolerance, case.max_refinements = 1e-9, 1
    return _core.analyze_part(case)


def row(part: Part, settings: StressSettings, factor: float) -> bool:
    """Prints one design; whether the true error lies inside the estimate."""
    start = time.process_time()
    case = part.stress_case(settings)  # type: ignore[attr-defined]
    sources = [fem.SizeSource(s.points, factor * s.size, s.growth, s.radius) for s in case.size.sources]
    case.size = fem.SizeField(case.size.base, sources)
    analyzed = _core.analyze_part(case)
    seconds = time.process_time() - start
    result, exact = analyzed.result, reference(part, settings).result
    deviation = result.peak_stress / exact.peak_stress - 1.0
    estimate = result.stress_error / result.peak_stress
    holds = abs(result.peak_stress - exact.peak_stress) <= result.stress_error
    values = "×".join(f"{value:g}" for value in part.parameters.values())
    print(
        f"| {part.name} {values} | {result.peak_stress / MEGA:.2f} | {exact.peak_stress / MEGA:.2f} "
        f"| {100 * deviation:+.1f} % | {100 * estimate:.1f} % | {'yes' if holds else 'NO'} "
        f"| {100 * exact.stress_error / exact.peak_stress:.1f} % | {seconds:.2f} |",
        flush=True,
    )
    return holds


def main() -> None:
    step = int(sys.argv[1]) if len(sys.argv) > 1 else 1
    factor = float(sys.argv[2]) if len(sys.argv) > 2 else 1.0
    config = codesign.load_study("ironcub_paper").config
    print("| part | peak, MPa | reference | true error | estimate | inside | estimate of the reference | CPU s |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    inside = []
    for kind, name, designs in (
        (JetpackBracket, "jetpack_bracket", BRACKETS),
        (ForearmJetSupport, "forearm_support", FOREARMS),
    ):
        settings = stress_settings(config, name)
        inside += [row(kind(*theta), settings, factor) for theta in designs[::step]]
    print(f"\n{sum(inside)} of {len(inside)} true errors lie inside the estimate")


if __name__ == "__main__":
    main()
