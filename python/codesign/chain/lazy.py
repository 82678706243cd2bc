"""Evaluations that stop as soon as a design cannot enter the front: the flight first, strength and clearances last.

Where a study says `lazy = "strength"`, clearances are measured with the flight, and only strength is left for last.
What is not computed has no number: the reason says so. A feasible evaluation is always whole.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from codesign.chain.chain import Flown, compute, evaluate, flight_numbers, flown_document, make
from codesign.chain.judge import FLIGHT_MISSED, Verdict, judge, limits
from codesign.chain.provenance import provenance
from codesign.errors import CodesignError
from codesign.problem.design_space import Design
from codesign.problem.evaluation import Evaluation
from codesign.problem.pareto import rival_of
from codesign.problem.quantities import FAMILY, MINUS, Quantity, quantity

if TYPE_CHECKING:
    from codesign.problem.protocols import PartCache, Rival
    from codesign.study import StudyData
    from codesign.study.config import StudyConfig

NOT_COMPUTED = "strength and clearances not computed"
STRENGTH_NOT_COMPUTED = "strength not computed"
FLIGHT, CLEARANCES, MASSES = "flight.", "flight.interference", "mass"


def evaluate_lazily(
    study: StudyData, design: Design, rivals: Sequence[Rival], cache: PartCache | None = None
) -> Evaluation:
    """As `chain.evaluate`, but a design that cannot enter the front is flown only.

    rivals: number and objectives of feasible designs; one that a rival is nowhere worse than is `skipped`, one whose
    flight is lost or misses a limit of the flight is `infeasible` without further numbers. Where objectives need more
    than flight and masses, every design is evaluated whole.
    """
    config = study.configured(design)
    if not can_wait(config):
        return evaluate(study, design, cache=cache)
    try:
        early, flown = _flown_only(study, design, config, rivals, cache)
    except CodesignError as error:
        return Evaluation.failure(design.to_dict(), f"{type(error).__name__}: {error}", provenance(study))
    return early or evaluate(study, design, cache=cache, flown=flown)


def can_wait(config: StudyConfig) -> bool:
    """Whether flight and masses give all objectives, and something else is left to compute."""
    wanted = [quantity(key.removeprefix(MINUS)) for key in config.objectives.keys]
    return config.flight is not None and all(_early(q, config) or _massive(q) for q in wanted)


def _measures_early(config: StudyConfig) -> bool:
    """Whether clearances are measured with the flight."""
    return config.execution.lazy == "strength"


def _early(wanted: Quantity, config: StudyConfig) -> bool:
    """Whether a flight gives a number."""
    path = wanted.path or wanted.key
    late = path.startswith(CLEARANCES) and not _measures_early(config)
    return wanted.key in FAMILY or (path.startswith(FLIGHT) and not late)


def _massive(wanted: Quantity) -> bool:
    """Whether it is made of masses of parts."""
    path = (wanted.path or wanted.key).rstrip(")")
    return ".".join(path.split(".")[2:]) == MASSES and "parts." in path


def _flown_only(
    study: StudyData, design: Design, config: StudyConfig, rivals: Sequence[Rival], cache: PartCache | None
) -> tuple[Evaluation | None, Flown]:
    """The evaluation, if the flight decides it; and what was done for it."""
    start = time.perf_counter()
    made = make(study, design, config, cache)
    result = compute(study, config, [], made.robot, None)
    if not result.flights:
        return None, Flown(made, result, time.perf_counter() - start)
    masses = {name: {MASSES: float(mass.mass)} for name, mass in made.masses.items()}
    numbers = flight_numbers(config, made.parts, made.robot, result) if _measures_early(config) else None
    document = {"parts": masses, **(numbers or flown_document(config, result.flights, result.seconds["flight"]))}
    chosen = [
        limit for limit in limits(config) if _early(limit.quantity, config) or limit.quantity.key == FLIGHT_MISSED
    ]
    verdict = judge(config, {"design": design.to_dict(), **document}, study.functions, chosen)
    rival = None if verdict.status == "infeasible" else rival_of(rivals, verdict.objectives.values())
    if verdict.status != "infeasible" and rival is None:
        return None, Flown(made, result, time.perf_counter() - start, numbers)
    seconds = {"geometry": made.seconds, **result.seconds, "total": time.perf_counter() - start}
    missing = STRENGTH_NOT_COMPUTED if _measures_early(config) else NOT_COMPUTED
    stopped = _stopped(study, design, verdict, rival, document | {"parts": {}}, seconds, missing)
    return stopped, Flown(made, result, seconds["total"], numbers)


def _stopped(
    study: StudyData,
    design: Design,
    verdict: Verdict,
    rival: int | None,
    document: Mapping[str, Any],
    seconds: dict[str, float],
    missing: str,
) -> Evaluation:
    reason = verdict.reason if rival is None else f"design {rival} is nowhere worse"
    return Evaluation(
        design=design.to_dict(),
        status="infeasible" if rival is None else "skipped",
        reason=f"{reason}; {missing}",
        objectives=verdict.objectives,
        constraints=verdict.constraints,
        violations=verdict.violations,
        margins=verdict.margins,
        **document,
        seconds=seconds,
        provenance=provenance(study),
    )
