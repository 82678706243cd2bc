"""Parts of a design confirmed: in full, on meshes refined at the peaks until every load case is settled.

A run keeps and resumes confirmations as it does flights on other trajectories: under a name in their place.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from codesign import _core
from codesign.chain.chain import build_parts, part_key, stress_settings
from codesign.chain.provenance import provenance
from codesign.errors import CodesignError
from codesign.parts.load_case import part_case
from codesign.parts.strength import confirming, part_document
from codesign.problem.design_space import Design
from codesign.problem.evaluation import Evaluation
from codesign.problem.quantities import quantity, read

if TYPE_CHECKING:
    from codesign.problem.protocols import PartCache
    from codesign.study import StudyData

CONFIRMED = "~confirmed"  # in place of a trajectory; no study can name one so


def evaluate_confirmed(study: StudyData, design: Design, cache: PartCache | None) -> Evaluation:
    """The parts of a design confirmed; nothing flies, nothing is ranked: status `skipped`.

    A part's `stopped` says why its error is still above the tolerance, None where it is not. Load cases whose loads the
    flight gives, natural frequencies and buckling are left out. A CodesignError gives a failed evaluation.
    """
    start = time.perf_counter()
    try:
        config = study.configured(design)
        parts: dict[str, dict[str, Any]] = {}
        for name, part in build_parts(study, design, config).items():
            settings = replace(confirming(stress_settings(config, name)), modes=0, buckling=0)
            key = part_key(study, part, settings)
            document = cache.get(key) if cache is not None else None
            if document is None:
                analysis = _core.analyze_part(part_case(part, settings))
                document = part_document(part.mass_properties(), analysis) | {"stopped": analysis.stopped or None}
                if cache is not None:
                    cache.put(key, document)
            parts[name] = document
    except CodesignError as error:
        return Evaluation.failure(design.to_dict(), f"{type(error).__name__}: {error}", provenance(study))
    seconds = {"total": time.perf_counter() - start}
    told = "its parts alone were analyzed, in full on fine meshes"
    return Evaluation(design.to_dict(), "skipped", told, parts=parts, seconds=seconds, provenance=provenance(study))


def with_confirmed(evaluation: Evaluation, confirmed: Mapping[str, Mapping[str, Any]]) -> Evaluation:
    """An evaluation with the strength of its parts as confirmed, and so the safety factors among its constraints.

    All else, and flown load cases, are as they were.
    """
    parts = {
        name: _merged(part, confirmed[name]) if name in confirmed else part for name, part in evaluation.parts.items()
    }
    return replace(evaluation, parts=parts, constraints={**evaluation.constraints, **_strength_of(evaluation, parts)})


def _strength_of(evaluation: Evaluation, parts: Mapping[str, Mapping[str, Any]]) -> dict[str, float]:
    """The safety factors among an evaluation's constraints, read from these parts."""
    found: dict[str, float] = {}
    for key in evaluation.constraints:
        path = quantity(key).path
        if path.startswith(("parts.", "min(parts.")) and path.rstrip(")").endswith(".safety_factor"):
            value = read({"parts": parts}, path)
            found |= {} if value is None else {key: value}
    return found


def _merged(part: Mapping[str, Any], confirmed: Mapping[str, Any]) -> dict[str, Any]:
    strength = {key: value for key, value in confirmed.items() if key not in ("mass", "com", "inertia", "seconds")}
    cases = {**part.get("cases", {}), **confirmed["cases"]}
    if part.get("load_case") not in confirmed["cases"]:  # a flown case decides
        strength = {}
    return {**part, **strength, "cases": cases, "confirmed": True}
