"""Strength of a part as JSON, and its confirmation: the part as analyzed beside its full geometry."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from codesign import _core, fem
from codesign.parts.load_case import StressSettings, part_case
from codesign.units import MILLIMETER

if TYPE_CHECKING:
    from codesign.parts.part import Part

GROWING = 0.1  # change of a peak by a refinement, relative, from which on the shape is to blame


def part_document(mass: Any, analysis: _core.PartAnalysis) -> dict[str, Any]:
    """Numbers of one part for JSON, SI units: those of the load case that governs, and the strength in every case.

    `buckling_factor` is None if the load cannot buckle the part, `safety_factor` if it does not stress it.
    """
    result = analysis.result
    optional: dict[str, Any] = {}
    if analysis.refinements:
        optional = {"refinements": analysis.refinements, "change": analysis.convergence[analysis.governing].change}
    if len(analysis.frequencies):
        optional["first_frequency"] = float(analysis.frequencies[0])
        optional["frequencies"] = [float(f) for f in analysis.frequencies]
    if len(analysis.buckling_factors):
        lowest = float(analysis.buckling_factors[0])
        optional["buckling_factor"] = lowest if math.isfinite(lowest) else None
    return {
        "mass": float(mass.mass),
        "com": [float(x) for x in mass.com],
        "inertia": [[float(x) for x in row] for row in mass.inertia],
        **strength_document(result),
        "load_case": analysis.case_names[analysis.governing],
        "cases": {name: _case_document(analysis, i) for i, name in enumerate(analysis.case_names)},
        "tolerance_reached": analysis.converged,
        **optional,
        "max_displacement": result.max_displacement,
        "work": result.work,
        "nodes": len(analysis.mesh.nodes),
        "tetrahedra": len(analysis.mesh.tets),
        "seconds": {"mesh": analysis.mesh_seconds, "solve": analysis.solve_seconds},
    }


def _case_document(analysis: _core.PartAnalysis, case: int) -> dict[str, Any]:
    """A load case; where meshes may be refined also the `change` of its peak, whether it is `settled`, and if not why.

    `change` is None if no mesh was refined around the peak, `next_step` if the case is settled.
    """
    result = analysis.results[case]
    document = strength_document(result) | {"max_displacement": result.max_displacement, "work": result.work}
    if not analysis.convergence:
        return document
    found = analysis.convergence[case]
    return document | {
        "change": found.change if found.refined else None,
        "settled": found.settled,
        "next_step": None if found.settled else next_step(result, found, analysis.failure),
    }


def next_step(result: fem.StaticResult, found: _core.CaseConvergence, failure: str) -> str:
    """What to do about a load case whose peak stress is not settled. failure: of a finer mesh, "" without any."""
    place = "({:.4g}, {:.4g}, {:.4g}) mm".format(*(x / MILLIMETER for x in result.peak_position))
    if result.peak_at_exclusion:
        return (
            f"the peak at {place} lies at the rim of a clamp or load, where no mesh settles it: hold or load the part "
            "as it is in truth, or judge the place by hand"
        )
    if failure:
        return f"the peak at {place} needs a finer mesh, but {failure}"
    if found.change > GROWING:
        return (
            f"the last refinement moved the peak at {place} by {100 * found.change:.2g} %, as in a corner without a "
            "radius: round it, or judge the place by hand"
        )
    return f'start from a finer mesh, [fem] accuracy = "fine" or a smaller edge_length_mm; the peak is at {place}'


def strength_document(result: fem.StaticResult) -> dict[str, Any]:
    """What decides the safety factor, for JSON, SI units.

    `safety_factor` is None if nothing is stressed, `left_out` (the largest stress that the exclusion leaves out) if it
    leaves out nothing. `peak_at_exclusion` is True if the peak lies right beside what the exclusion leaves out;
    `border_distance`: of the peak from the nearest clamp or load, None without any. `peak_resolved` is False if the
    estimated error exceeds half of the peak.
    """
    hidden = result.left_out
    left_out = {
        "stress": hidden.stress,
        "position": [float(x) for x in hidden.position],
        "border_distance": hidden.border_distance,
    }
    return {
        "safety_factor": result.safety_factor if math.isfinite(result.safety_factor) else None,
        "peak_stress": result.peak_stress,
        "peak_position": [float(x) for x in result.peak_position],
        "border_distance": result.border_distance if math.isfinite(result.border_distance) else None,
        "peak_at_exclusion": result.peak_at_exclusion,
        "peak_resolved": result.peak_resolved,
        "stress_50": result.stress_50,
        "stress_error": result.stress_error,
        "left_out": left_out if hidden.stress > 0.0 else None,
    }


@dataclass(frozen=True, slots=True)
class Confirmation:
    """A part as the optimization analyses it beside the part as it is made; documents as of `part_document`.

    confirmed: full geometry, fine mesh, refined around the peak of every load case; `settled` of each case says whether
    that was enough, `tolerance_reached` whether it was for all. Load cases whose loads the flight gives are not in it.
    """

    analyzed: dict[str, Any]
    confirmed: dict[str, Any]

    @property
    def cases(self) -> dict[str, dict[str, Any]]:
        """Of every load case, SI units: safety factor, peak and error as searched and as confirmed, what is settled."""
        kept = ("safety_factor", "peak_stress", "stress_error")
        found = {}
        for name, confirmed in self.confirmed["cases"].items():
            searched = self.analyzed["cases"][name]
            found[name] = {
                "searched": {key: searched[key] for key in kept},
                "confirmed": {key: confirmed[key] for key in kept},
                **{key: confirmed[key] for key in ("change", "settled", "next_step")},
            }
        return found


def confirming(settings: StressSettings) -> StressSettings:
    """Settings that analyze the full geometry on a mesh refined at the peaks until the tolerance is reached.

    Load cases whose loads the flight gives are left out: nothing flies.
    """
    return replace(settings, geometry="full", accuracy="converged", flown=())


def confirm(part: Part, settings: StressSettings) -> Confirmation:
    """Analyses a part with the given settings, and its full geometry on a fine mesh until the tolerance is reached.

    Raises: MeshError, SolverError, GeometryError.
    """
    mass = part.mass_properties()
    analyzed, confirmed = (
        part_document(mass, _core.analyze_part(part_case(part, chosen))) for chosen in (settings, confirming(settings))
    )
    return Confirmation(analyzed, confirmed)
