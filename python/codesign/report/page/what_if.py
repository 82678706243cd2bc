"""The section with a slider for each variable: its text, and the models as the page's script reads them."""

from __future__ import annotations

from html import escape
from typing import Any

from codesign.problem.design_space import Variable
from codesign.problem.quantities import Quantity, quantity
from codesign.report.data import ReportData
from codesign.surrogate.what_if import NumberModel, WhatIf

TEXT = (
    "Predictions of a model of the evaluated designs (Gaussian processes), no evaluations: dark bands hold 50 %, light "
    "ones 90 % of designs like those evaluated; of designs that a search chooses by such models perhaps fewer. "
    "Leave-one-out tells how far each evaluated design is from what the others predict, as a share of the spread, and "
    "how many lie in their 90 % band. Before building a design, evaluate it."
)


def what_if_models(run: ReportData) -> WhatIf | None:
    """The models of a run; None if it has too few designs."""
    evaluations = [entry.evaluation for entry in run.entries]
    constraints = list(dict.fromkeys(key for e in evaluations for key in e.constraints))
    return WhatIf.of(run.space, evaluations, run.front, run.keys, constraints)


def what_if_document(run: ReportData, models: WhatIf | None) -> dict[str, Any] | None:
    """What the script needs to predict: designs by row, lengths and scales; the values stand in the rows already."""
    if models is None:
        return None
    document: dict[str, Any] = {
        "variables": [_variable(variable) for variable in run.variables],
        "entries": list(models.entries),
        "grids": models.grids.tolist(),
        "lowest": models.lowest.tolist(),
        "highest": models.highest.tolist(),
        "numbers": [_number(run, models, number) for number in models.numbers],
        "completed": None,
    }
    process = models.completed.output.process if models.completed is not None else None
    if process is not None and models.completed is not None:
        document["completed"] = {
            "lengths": _lengths(models, process.column_lengths),
            "noise": process.noise,
            "least": models.completed.least_deviation,
            "values": [int(run.entries[i].evaluation.objectives != {}) for i in models.entries],
        }
    return document


def section_text(run: ReportData, models: WhatIf) -> str:
    """The section's introduction, which names the numbers that are predicted badly."""
    poor = [shown_quantity(run, number.key).label for number in models.numbers if number.quality.poor]
    return escape(TEXT + (f" Do not rely on the predictions of {', '.join(poor)}." if poor else ""))


def shown_quantity(run: ReportData, key: str) -> Quantity:
    """Words and unit of an objective or constraint of a run."""
    return run.objectives[run.keys.index(key)] if key in run.keys else quantity(key)


def _variable(variable: Variable) -> dict[str, Any]:
    values = list(variable.values) or [variable.value(i) for i in range(variable.levels)]
    return {"values": values, "named": variable.named}


def _number(run: ReportData, models: WhatIf, number: NumberModel) -> dict[str, Any]:
    process, objective = number.process, number.key in run.keys
    shown = shown_quantity(run, number.key)
    evaluations = [run.entries[models.entries[row]].evaluation for row in number.rows]
    values = [float((e.objectives if objective else e.constraints)[number.key]) for e in evaluations]
    sign, limit = run.limits.get(number.key, ("", 0.0))
    return {
        "key": number.key,
        "label": shown.label,
        "unit": shown.unit,
        "factor": shown.factor,
        "objective": run.keys.index(number.key) if objective else None,
        "limit": [sign, shown.shown(limit)] if sign and not objective else None,
        "rows": number.rows.tolist(),
        "values": [float(f"{value:.9g}") for value in values],
        "lengths": _lengths(models, process.column_lengths),
        "noise": process.noise,
        "scaling": [number.scaling.median, number.scaling.unit] if number.scaling else None,
        "quality": [round(number.quality.error, 4), round(number.quality.coverage, 4)],
        "poor": number.quality.poor,
    }


def _lengths(models: WhatIf, column_lengths: Any) -> list[float]:
    """A length for each variable; its columns share it."""
    variable = models.coordinates.variable
    return [float(column_lengths[variable == number][0]) for number in range(models.coordinates.variables)]
