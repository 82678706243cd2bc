"""What `codesign check` tells of a sound study: what varies, what is minimized, what must hold, what a design costs."""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING, Any

from rich.table import Table

from codesign.chain.judge import limits
from codesign.cli.console import out, shown

if TYPE_CHECKING:
    from codesign.chain.study import Study


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
    }  # fmt: skip


def measured(study: Study) -> dict[str, Any]:
    """One evaluation, of the baseline or else of the middle of the grid: its status, reason, wall and own times [s]."""
    middle = study.space.from_indices([(levels - 1) // 2 for levels in study.space.levels])
    start = time.perf_counter()
    evaluation = study.evaluate(study.baseline or middle)
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
    if "evaluation" not in summary:
        return
    one = summary["evaluation"]
    told = f"one evaluation ({one['status']}): {one['wall_seconds']:.2f} s"
    out.print(told + (f"; {one['reason']}" if one["reason"] else ""), highlight=False)
    count = summary["population"] * summary["generations"]
    hours = count * one["wall_seconds"] / summary["workers"] / 3600.0
    searched = f"{count:,} evaluations of the search on {summary['workers']} workers: about {hours:.2g} h"
    out.print(searched, highlight=False)


def _limit(limit: dict[str, Any]) -> str:
    bounds = [
        f"{sign} {shown(limit['factor'] * limit[key])} {limit['unit']}".rstrip()
        for sign, key in (("≥", "min"), ("≤", "max"))
        if limit[key] is not None
    ]
    return f"{limit['label']} {' '.join(bounds)}"
