"""Numbers of single parts into the cache: a design whose parts are known there meshes and solves nothing."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import TYPE_CHECKING

from codesign import _core
from codesign.chain.chain import build_parts, part_key, stress_settings
from codesign.chain.provenance import provenance
from codesign.errors import CodesignError
from codesign.parts.load_case import part_case
from codesign.parts.strength import part_document
from codesign.problem.design_space import Design
from codesign.problem.evaluation import Evaluation

if TYPE_CHECKING:
    from codesign.problem.protocols import PartCache
    from codesign.study import StudyData

MASS = "mass"
LOOKS = 9  # values of a variable that are tried to see whether it changes a part


def start_design(study: StudyData) -> Design:
    """The study's original design, else the middle of its grid."""
    middle = study.space.from_indices([levels // 2 for levels in study.space.levels])
    return study.baseline or middle


def deciding_variables(study: StudyData, name: str) -> tuple[str, ...]:
    """Names of the variables that change a part or how it is analyzed, seen from the start design or a corner."""
    corners = ([0] * len(study.space.levels), [levels - 1 for levels in study.space.levels])
    bases = [study.space.indices(start_design(study)), *map(tuple, corners)]
    return tuple(
        variable.name
        for i, variable in enumerate(study.space.variables)
        if any(len(set(_keys(study, name, base, i))) > 1 for base in bases)
    )


def _keys(study: StudyData, name: str, base: tuple[int, ...], variable: int) -> Iterator[str]:
    """Cache keys of a part along one variable, at LOOKS of its values; designs that are refused have none."""
    levels = study.space.levels[variable]
    for level in sorted({round(k * (levels - 1) / (LOOKS - 1)) for k in range(LOOKS)}):
        design = study.space.from_indices([*base[:variable], level, *base[variable + 1 :]])
        try:
            config = study.configured(design)
            yield part_key(study, build_parts(study, design, config)[name], stress_settings(config, name))
        except CodesignError:
            continue


def flies_for_strength(study: StudyData, name: str) -> bool:
    """Whether a part's strength needs the flight of every design, so that no table of the part can spare it."""
    return bool(stress_settings(study.config, name).flown)


def analyze_alone(study: StudyData, design: Design, name: str, cache: PartCache | None) -> Evaluation:
    """One part of a design, from the cache or analyzed and put there; the others and the flight are left out.

    A CodesignError on the way gives a failed evaluation.
    """
    start = time.perf_counter()
    try:
        config = study.configured(design)
        part, settings = build_parts(study, design, config)[name], stress_settings(config, name)
        key = part_key(study, part, settings)
        document = cache.get(key) if cache is not None else None
        if document is None:
            document = part_document(part.mass_properties(), _core.analyze_part(part_case(part, settings)))
            if cache is not None:
                cache.put(key, document)
    except CodesignError as error:
        return Evaluation.failure(design.to_dict(), f"{type(error).__name__}: {error}", provenance(study))
    factor = document["safety_factor"]
    return Evaluation(
        design=design.to_dict(),
        status="feasible",
        objectives={MASS: document["mass"]},
        constraints={} if factor is None else {"safety_factor": factor},
        parts={name: document},
        seconds={"total": time.perf_counter() - start},
        provenance=provenance(study),
    )
