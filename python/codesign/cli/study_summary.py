"""What `codesign check` tells of a sound study: what varies, what is minimized, what must hold, what a design costs."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from rich.table import Table

from codesign.chain.judge import FLIGHT_MISSED, LIMITS, Limit, limits
from codesign.cli.console import out, shown
from codesign.problem.numbers import known_number
from codesign.problem.quantities import MINUS
from codesign.study.checking.cancelling import cancelled_loads
from codesign.study.checking.cases import idle_cases
from codesign.study.checking.numbers import constant_numbers
from codesign.study.checking.problems import Problem
from codesign.study.checking.ranges import Refusal
from codesign.study.parts import bodies_given_twice

if TYPE_CHECKING:
    from codesign.chain.study import Study
    from codesign.problem.design_space import Design


def study_summary(study: Study, refusals: Sequence[Refusal] = ()) -> dict[str, Any]:
    """Variables, size of the grid, objectives and limits (SI units) of a study. refusals: values that give no part."""
    return {
        "study": study.name,
        "hash": study.hash,
        "variables": [
            {"name": v.name, "values": str(v), "unit": v.unit, "levels": v.levels} for v in study.space.variables
        ],
        "designs": math.prod(study.space.levels),
        "objectives": list(study.objectives),
        "limits": [
            {"key": limit.quantity.key, "label": limit.quantity.label, "unit": _unit(limit),
             "factor": limit.quantity.factor, "min": limit.least, "max": limit.most, "origin": limit.origin,
             "default": _by_default(study, limit.origin)}
            for limit in limits(study.config)
        ],
        "population": study.optimizer.population,
        "generations": study.optimizer.generations,
        "workers": study.execution.workers,
        "control": control(study),
        "notes": [f"{key}: {reason}" for key, reason in notes(study, refusals)],
    }  # fmt: skip


def notes(study: Study, refusals: Sequence[Refusal] = ()) -> Iterator[Problem]:
    """What is no mistake, but may not be what was meant. refusals: values that give no part."""
    yield from constant_numbers(study.config)
    yield from idle_cases(study.config)
    yield from cancelled_loads(study.config)
    yield from bodies_given_twice(study.config, study.base_robot)
    yield from ((key, reason) for key, reason, _ in refusals)


def hopeless(study: Study, refusals: Sequence[Refusal]) -> Iterator[Problem]:
    """Why no design can come of a study that can be loaded: its robot cannot fly, or no values give a part."""
    if why := study.grounded:
        yield "flight", why
    yield from ((key, reason) for key, reason, every in refusals if every)


def _unit(limit: Limit) -> str:
    known = known_number(limit.quantity.key)
    return limit.quantity.unit or (known.unit if known else "")


def _by_default(study: Study, origin: str) -> bool:
    """Whether a limit is there although the study file does not say so."""
    section, _, key = origin.partition(".")
    return section == "constraints" and "." not in key and origin != LIMITS and key not in study.raw.get(section, {})


def typical(study: Study) -> Design:
    """The baseline, or else the middle of the grid."""
    return study.baseline or study.space.from_indices([(levels - 1) // 2 for levels in study.space.levels])


def control(study: Study) -> dict[str, Any]:
    """What thrusts and joints can do at the start posture, for a typical design; empty without a flight."""
    return asdict(study.controllability(typical(study))) if study.config.flight else {}


def measured(study: Study) -> dict[str, Any]:
    """Evaluations of a typical design and of both ends of the grid: status, reason, processor times [s].

    constant: objectives and limits that had the same value in all of them.
    """
    levels = study.space.levels
    ends = (study.space.from_indices([0] * len(levels)), study.space.from_indices([n - 1 for n in levels]))
    designs = []
    for design in dict.fromkeys((typical(study), *ends)):
        start = time.process_time()
        evaluation = study.evaluate(design)
        designs.append(
            {
                "design": evaluation.design,
                "status": evaluation.status,
                "reason": evaluation.reason,
                "cpu_seconds": time.process_time() - start,
                "seconds": evaluation.seconds,
                "numbers": evaluation.constraints | evaluation.objectives,
            }
        )
    return {"designs": designs, "constant": _same_in_all(designs)}


def _same_in_all(designs: Sequence[dict[str, Any]]) -> dict[str, float]:
    """Numbers with one value in several designs, but for that of a completed flight."""
    first, *others = [design["numbers"] for design in designs if design["status"] != "failed"] or [{}]
    return {
        key: value
        for key, value in first.items()
        if others and key != FLIGHT_MISSED and all(other.get(key) == value for other in others)
    }


def print_study(summary: dict[str, Any]) -> None:
    """The summary as text."""
    table = Table("variable", "values", "number", box=None, pad_edge=False)
    for variable in summary["variables"]:
        table.add_row(variable["name"], variable["values"], str(variable["levels"]))
    out.print(table)
    out.print(f"{summary['designs']:,} designs", highlight=False)
    objectives = summary["objectives"]
    for word, names in (
        ("minimized", [name for name in objectives if not name.startswith(MINUS)]),
        ("maximized", [name.removeprefix(MINUS) for name in objectives if name.startswith(MINUS)]),
    ):
        if names:
            out.print(f"{word}: {', '.join(names)}", highlight=False, markup=False, soft_wrap=True)
    out.print("limited:")
    for limit in summary["limits"]:
        out.print(f"  {_limit(limit)}", highlight=False, markup=False, soft_wrap=True)
    print_control(summary["control"])
    for note in summary["notes"]:
        out.print(f"note: {note}", highlight=False, markup=False, soft_wrap=True)
    if "evaluation" in summary:
        _print_costs(summary)


def _print_costs(summary: dict[str, Any]) -> None:
    """What the measured designs cost, what the search would, and which numbers were the same in all of them."""
    found = summary["evaluation"]
    for one in found["designs"]:
        values = ", ".join(f"{name} = {shown(value)}" for name, value in one["design"].items())
        told = f"{one['cpu_seconds']:.2f} s of processor time: {values} ({one['status']})"
        out.print(told + (f"; {one['reason']}" if one["reason"] else ""), highlight=False, markup=False, soft_wrap=True)
    times = sorted(one["cpu_seconds"] for one in found["designs"])
    count = summary["population"] * summary["generations"]
    least, most = (count / summary["workers"] * seconds for seconds in (times[0], times[-1]))
    unit, length = ("h", 3600.0) if most >= 3600.0 else ("min", 60.0)
    searched = f"{count:,} evaluations of the search on {summary['workers']} workers, a core each"
    out.print(f"{searched}: {least / length:.2g} to {most / length:.2g} {unit}", highlight=False, soft_wrap=True)
    for key, value in found["constant"].items():
        out.print(f"note: {key} was {shown(value)} in all of them: does it decide anything?", highlight=False)


def print_control(control: dict[str, Any]) -> None:
    """One line of what jets and joints reach, and what to know about it."""
    if not control:
        return
    out.print(
        f"control: rank {control['rank']} of 6, condition {control['condition']:.2g}, "
        f"thrust carries {control['hover_margin']:.2g} times the weight",
        highlight=False,
    )
    for note in filter(None, (control["reason"], *control["notes"])):
        out.print(f"  {note}", highlight=False)


def _limit(limit: dict[str, Any]) -> str:
    bounds = [
        f"{sign} {shown(limit['factor'] * limit[key])} {limit['unit']}".rstrip()
        for sign, key in (("≥", "min"), ("≤", "max"))
        if limit[key] is not None
    ]
    origin = f"{limit['origin']}, its default" if limit["default"] else limit["origin"]
    return f"{limit['label']} {' '.join(bounds)} ({origin})"
