"""What `codesign check` tells of a sound study: what varies, what is minimized, what must hold, what a design costs."""

from __future__ import annotations

import math
import time
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from rich.table import Table

from codesign.chain.judge import limits
from codesign.cli.console import out, shown

if TYPE_CHECKING:
    from codesign.chain.study import Study
    from codesign.problem.design_space import Design


def study_summary(study: Study) -> dict[str, Any]:
    """Variables, size of the grid, objectives and limits (SI units) of a study."""
    return {
        "study": study.name,
        "hash": study.hash,
        "variables": [
            {"name": v.name, "values": str(v), "unit": v.unit, "levels": v.levels} for v in study.space.variables
        ],
        "designs": math.prod(study.space.levels),
        "objectives": list(study.objectives),
        "limits": [
            {"key": limit.quantity.key, "label": limit.quantity.label, "unit": limit.quantity.unit,
             "factor": limit.quantity.factor, "min": limit.least, "max": limit.most}
            for limit in limits(study.config)
        ],
        "population": study.optimizer.population,
        "generations": study.optimizer.generations,
        "workers": study.execution.workers,
        "control": control(study),
    }  # fmt: skip


def typical(study: Study) -> Design:
    """The baseline, or else the middle of the grid."""
    return study.baseline or study.space.from_indices([(levels - 1) // 2 for levels in study.space.levels])


def control(study: Study) -> dict[str, Any]:
    """What thrusts and joints can do at the start posture, for a typical design; empty without a flight."""
    return asdict(study.controllability(typical(study))) if study.config.flight else {}


def measured(study: Study) -> dict[str, Any]:
    """One evaluation of a typical design: its status, reason, wall and own times [s]."""
    start = time.perf_counter()
    evaluation = study.evaluate(typical(study))
    wall = time.perf_counter() - start
    return {
        "design": evaluation.design,
        "status": evaluation.status,
        "reason": evaluation.reason,
        "wall_seconds": wall,
        "seconds": evaluation.seconds,
    }


def print_study(summary: dict[str, Any]) -> None:
    """The summary as text."""
    table = Table("variable", "values", "number", box=None, pad_edge=False)
    for variable in summary["variables"]:
        table.add_row(variable["name"], variable["values"], str(variable["levels"]))
    out.print(table)
    out.print(f"{summary['designs']:,} designs", highlight=False)
    out.print(f"minimized: {', '.join(summary['objectives'])}")
    out.print(f"limited: {', '.join(map(_limit, summary['limits']))}")
    print_control(summary["control"])
    if "evaluation" not in summary:
        return
    one = summary["evaluation"]
    told = f"one evaluation ({one['status']}): {one['wall_seconds']:.2f} s"
    out.print(told + (f"; {one['reason']}" if one["reason"] else ""), highlight=False)
    count = summary["population"] * summary["generations"]
    hours = count * one["wall_seconds"] / summary["workers"] / 3600.0
    searched = f"{count:,} evaluations of the search on {summary['workers']} workers: about {hours:.2g} h"
    out.print(searched, highlight=False)


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
    return f"{limit['label']} {' '.join(bounds)}"
