"""The run as the page's script reads it: one JSON document with compact rows."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from codesign.problem.evaluation import Evaluation
from codesign.problem.quantities import Quantity, quantity, words
from codesign.report.data import ReportData
from codesign.report.details import detail_key
from codesign.report.objections import Objection
from codesign.report.strength import strength_words
from codesign.units import DEGREE

STATUS = {"feasible": 0, "infeasible": 1, "failed": 2, "skipped": 3}
FLOORS = {"body_clearance": 0.0, "plume_clearance": 0.0}  # below it a number is bad, whether limited or not
PART_KEYS = ("mass", "safety_factor", "peak_stress", "stress_error", "max_displacement")
FLIGHT_FACTS = (
    Quantity("max_com_error", "Largest tracking error", "cm", factor=100.0),
    Quantity("max_attitude_error", "Largest attitude error", "°", factor=1.0 / DEGREE),
    Quantity("min_thrust", "Lowest thrust", "N"),
    Quantity("max_thrust", "Highest thrust", "N"),
    Quantity("duration", "Flown", "s"),
)


def page_document(
    run: ReportData, details: dict[str, Any] | None = None, files: dict[str, Any] | None = None
) -> dict[str, Any]:
    """Everything the page shows, as JSON values. details, files: by `detail_key`."""
    constraints = [key for key in _constraint_keys(run) if key != "flight_missed_share" or _any_nonzero(run, key)]
    parts = list(dict.fromkeys(name for e in run.entries for name in e.evaluation.parts))
    front = set(run.front)
    shown = {detail_key(evaluation) for evaluation in run.highlights.values()} | set(details or {})
    told = {i for i, e in enumerate(run.entries) if i in front or detail_key(e.evaluation) in shown}
    rows = [
        {
            "id": e.id,
            "front": i in front,
            **_against(run.objections(i)),
            **_row(run, e.evaluation, constraints, parts, files or {}, i in told),
        }
        for i, e in enumerate(run.entries)
    ]
    baseline = None
    if run.baseline is not None:
        baseline = run.find(run.baseline)
        if baseline is None:
            baseline = len(rows)
            against = _against(run.against(run.baseline))
            numbers = _row(run, run.baseline, constraints, parts, files or {})
            rows.append({"id": None, "front": False, **against, **numbers})
    about = _once(rows)
    return {
        "variables": [
            {"key": v.name, "label": run.label(v), "unit": _unit(v.unit), "min": v.minimum, "max": v.maximum}
            | ({"names": list(v.values)} if v.named else {})
            for v in run.variables
        ],
        "objectives": [_objective(o) | {"view": run.view(k)} for k, o in enumerate(run.objectives)],
        "constraints": [_constraint(run, key) for key in constraints],
        "parts": [{"key": name, "label": words(name)} for name in parts],
        "about": about,
        "flight_facts": [{"label": q.label, "unit": q.unit} for q in FLIGHT_FACTS],
        "designs": rows,
        "baseline": baseline,
        "recommended": run.recommended,
        "choices": run.choices,
        "best": run.best,
        "progress": progress(run),
        "compared": [
            {
                "name": other.name,
                "ids": list(other.ids),
                "f": [[_rounded(x) for x in run.signs * row] for row in other.values],
            }
            for other in run.compared
        ],
        "details": details or {},
        "command": run.export_command,
        "command_original": run.export_original,
    }


def _objective(o: Quantity) -> dict[str, Any]:
    """sign: -1 if more is better."""
    return {"key": o.key, "label": o.label, "sign": o.sign, "unit": o.unit, "title": o.title}


def _row(
    run: ReportData,
    evaluation: Evaluation,
    constraints: list[str],
    parts: list[str],
    files: dict[str, Any],
    told: bool = True,
) -> dict[str, Any]:
    """A design, its parts as confirmed; told: its strength in words, for which thousands of designs have no room."""
    key, searched = detail_key(evaluation), evaluation
    evaluation = run.as_confirmed(evaluation)
    row: dict[str, Any] = {
        "x": [evaluation.design[v.name] for v in run.variables],
        "status": STATUS[evaluation.status],
        "reason": evaluation.reason,
        "f": [_rounded(value) for value in run.shown(evaluation)],
        "c": [_shown(quantity(k), evaluation.constraints) for k in constraints],
        "g": [_rounded(_violation(run, evaluation, k)) for k in constraints],
        "p": [_part(evaluation.parts[name]) if name in evaluation.parts else None for name in parts],
        "s": [_strength(run, evaluation, name) for name in parts] if told else [],
        "about": [_about(run, evaluation, name) for name in parts] if told else None,
        "fl": [_shown(quantity, evaluation.flight) for quantity in FLIGHT_FACTS],
        "detail": key,
    }
    if evaluation is not searched:
        row["searched"] = [_part(searched.parts[name]) if name in searched.parts else None for name in parts]
    if key in files:
        row["files"] = files[key]
    return row


def _violation(run: ReportData, evaluation: Evaluation, key: str) -> float:
    """As judged, or of a confirmed number that misses its limit, relative to it."""
    sign, limit = run.demanded(evaluation).get(key, ("", 0.0))
    if evaluation.violations.get(key) or sign != ">=" or not limit:
        return evaluation.violations.get(key, 0.0)
    return max(0.0, (limit - evaluation.constraints.get(key, limit)) / abs(limit))


def _part(numbers: dict[str, Any]) -> list[float | None]:
    return [_rounded(numbers.get(key)) for key in PART_KEYS]


def _strength(run: ReportData, evaluation: Evaluation, name: str) -> list[str]:
    """Load cases, frequency and deciding place of a part in words."""
    part, known = evaluation.parts.get(name), run.describe(evaluation.design).parts.get(name)
    return strength_words(name, part, run.demanded(evaluation), known.carried if known else "") if part else []


def _against(found: Sequence[Objection]) -> dict[str, Any]:
    return {"against": [objection.text for objection in found], "barred": any(o.final for o in found)}


def _about(run: ReportData, evaluation: Evaluation, name: str) -> dict[str, str]:
    """Material and load of a part of a design: variables may set them."""
    known = run.describe(evaluation.design).parts.get(name)
    return {"load": known.load, "material": known.material, "warning": known.warning} if known else {}


def _once(rows: list[dict[str, Any]]) -> list[Any]:
    """What the rows say of material and load, each once: thousands say the same; rows keep the place in this list."""
    places: dict[str, int] = {}
    for row in rows:
        if row["about"]:
            row["about"] = places.setdefault(json.dumps(row["about"]), len(places))
    return [json.loads(text) for text in places]


def _shown(quantity: Quantity, numbers: Mapping[str, Any]) -> float | None:
    value = numbers.get(quantity.key)
    return None if value is None else _rounded(quantity.shown(value))


def _rounded(value: Any) -> float | None:
    """Seven significant digits: the store keeps the exact number, the page is read by people."""
    return None if value is None or not np.isfinite(value) else float(f"{value:.7g}")


def _constraint_keys(run: ReportData) -> list[str]:
    return list(dict.fromkeys(key for e in run.entries for key in e.evaluation.constraints))


def _any_nonzero(run: ReportData, key: str) -> bool:
    return any(e.evaluation.constraints.get(key) for e in run.entries)


def _constraint(run: ReportData, key: str) -> dict[str, Any]:
    """Words of a constraint; `rule` is empty for a number that is only watched."""
    shown = quantity(key)
    rule = ""
    if key in run.limits:
        sign, limit = run.limits[key]
        rule = f"{ {'>=': '≥', '<=': '≤'}[sign] } {shown.shown(limit):g}"
    return {
        "key": key,
        "label": shown.label,
        "unit": shown.unit,
        "meaning": shown.meaning,
        "rule": rule,
        "floor": FLOORS.get(key),
    }


def _unit(unit: str) -> str:
    return {"deg": "°", "1": ""}.get(unit, unit)


def progress(run: ReportData) -> dict[str, list[float]]:
    """Steps of the hypervolume, relative to the final one, for the chart of the search."""
    volume = run.hypervolume
    if not len(volume) or volume[-1] == 0:
        return {"count": [], "volume": []}
    steps = [0, *(np.flatnonzero(np.diff(volume) > 0) + 1).tolist(), len(volume) - 1]
    unique = sorted(set(steps))
    return {"count": [i + 1 for i in unique], "volume": [round(float(volume[i] / volume[-1]), 5) for i in unique]}
