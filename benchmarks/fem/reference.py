"""Stress of the shipped study's parts against reference values of independent solvers.

Reference: straight ten-node elements in two other codes, refined until converged; 250 N, E = 71.7 GPa,
nu = 0.3. Prints a row per design and quantity: value, reference, deviation, CPU time (surface to safety factor), nodes.
Usage: python benchmarks/fem/reference.py [--accuracy optimization|fine] [--geometry simplified|full] [--only forearm]
"""

from __future__ import annotations

import argparse
import resource
import time
from dataclasses import replace

import codesign
from codesign import _core
from codesign.chain.chain import build_parts, stress_settings
from codesign.parts.load_case import part_case

BRACKET, FOREARM = "jetpack_bracket", "forearm_support"
# Part, design -> quantity: value (MPa, MPa, mm, N mm); displacement and work of the bracket hold for the full part.
REFERENCE: list[tuple[str, dict[str, float], dict[str, float]]] = [
    (BRACKET, {"angle": 1, "distance": 47.9133}, {"peak": 5.2, "stress_50": 4.65, "u": 0.0174, "work": 2.235}),
    (BRACKET, {"angle": 15, "distance": 42}, {"peak": 4.62, "u": 0.0136}),
    (BRACKET, {"angle": 25, "distance": 80}, {"peak": 9.34}),
    (BRACKET, {"angle": 60, "distance": 60}, {"peak": 8.6}),
    (FOREARM, {"length": 50, "offset": 88}, {"peak": 33.1, "stress_50": 19.9, "u": 0.517, "work": 30.3}),
    (FOREARM, {"length": 150, "offset": 100}, {"peak": 36.4, "stress_50": 21.8, "u": 1.262, "work": 73.4}),
]
TOLERANCE = {"peak": 5.0, "stress_50": 3.0, "u": 2.0, "work": 2.0}  # %


def analyze(part: str, design: dict[str, float], accuracy: str, geometry: str) -> tuple[_core.PartAnalysis, float]:
    """The analysis of one part of the shipped study and its CPU time [s]."""
    study = codesign.load_study("ironcub_paper")
    theta = {"angle": 15.0, "distance": 42.0, "offset": 80.0, "length": 108.0} | design
    shape = build_parts(study, theta)[part]
    settings = replace(stress_settings(study.config, part), accuracy=accuracy, geometry=geometry)
    case = part_case(shape, settings)
    start = time.process_time()
    analysis = _core.analyze_part(case)
    return analysis, time.process_time() - start


def main() -> None:
    """Prints the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--accuracy", choices=("optimization", "fine"), default="optimization")
    parser.add_argument("--geometry", choices=("simplified", "full"), default="simplified")
    parser.add_argument("--only", default="")
    options = parser.parse_args()
    print("| part | design | quantity | value | reference | deviation | CPU s | nodes |")
    print("|---|---|---|---|---|---|---|---|")
    for part, design, reference in REFERENCE:
        if options.only not in part:
            continue
        analysis, seconds = analyze(part, design, options.accuracy, options.geometry)
        result = analysis.result
        values = {
            "peak": result.peak_stress / 1e6,
            "stress_50": result.stress_50 / 1e6,
            "u": result.max_displacement * 1e3,
            "work": result.work * 1e3,
        }
        for quantity, wanted in reference.items():
            deviation = 100.0 * (values[quantity] / wanted - 1.0)
            remark = ""
            if part == BRACKET and quantity in ("u", "work") and options.geometry == "simplified":
                remark = " (full part)"
            elif abs(deviation) > TOLERANCE[quantity]:
                remark = " outside"
            name = ", ".join(f"{value:g}" for value in design.values())
            print(
                f"| {part} | {name} | {quantity} | {values[quantity]:.4g} | {wanted:g} | {deviation:+.1f} %{remark} "
                f"| {seconds:.2f} | {len(analysis.mesh.nodes)} |"
            )
        quality = analysis.mesh.quality
        print(
            f"| | | smallest angle {quality.min_dihedral_deg:.1f}° | error ± {result.stress_error / 1e6:.2g} MPa "
            f"| | | mesh {analysis.mesh_seconds:.2f}, solve {analysis.solve_seconds:.2f} | |"
        )
    print(f"largest resident memory {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MiB")


if __name__ == "__main__":
    main()
