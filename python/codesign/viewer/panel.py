"""What the viewer says beside its scene: the design in numbers with units, the scale of the colors, joint angles."""

from __future__ import annotations

from typing import Any

from codesign.problem.design_space import value_text
from codesign.problem.evaluation import Evaluation
from codesign.problem.quantities import words
from codesign.report.details import Detail
from codesign.report.figures.flights import sample_at
from codesign.report.figures.style import STRESS, STRESS_STOPS
from codesign.report.study_words import objective_quantities
from codesign.report.verdict import Verdict, study_verdict
from codesign.report.words import number, percent
from codesign.units import DEGREE, MEGA, MILLIMETER

CLOSEST = 3  # pairs of bodies that are named


def facts(study: Any, evaluation: Evaluation, original: Evaluation | None, verdict: Verdict | None = None) -> str:
    """What is known of a design, as Markdown; changes are from the original. verdict: of its run; None: it has none."""
    lines = [f"**{evaluation.status}**" + (f": {evaluation.reason}" if evaluation.reason else "")]
    if evaluation.status == "feasible":
        said = verdict or study_verdict(study, evaluation)
        lines += [f"**{said.title}**", *(f"**{said.head}**: {reason}" for reason in said.reasons)]
    for variable in study.space.variables:
        unit = {"deg": "°", "": ""}.get(variable.unit, f" {variable.unit}")
        label = words(study.config.variables[variable.name].label or variable.name)
        lines.append(f"{label}: **{value_text(evaluation.design[variable.name])}{unit}**")
    for objective in objective_quantities(tuple(evaluation.objectives), study.config):
        value = evaluation.objectives[objective.key]
        before = original.objectives.get(objective.key) if original is not None else None
        change = ""
        if before and original is not evaluation:
            change = f" ({percent(objective.sign * (value - before) / abs(before))})"
        lines.append(f"{objective.label}: **{number(objective.shown(value))}** {objective.unit}{change}")
    for name, part in evaluation.parts.items():
        if part.get("safety_factor"):
            lines.append(f"{words(name)}: safety factor **{number(part['safety_factor'], 3)}**, {part['mass']:.3f} kg")
    return "\n\n".join(lines + _clearances(evaluation))


def _clearances(evaluation: Evaluation) -> list[str]:
    """The closest pairs of bodies and of plumes, with the moment of the flight at which they are closest."""
    measured = evaluation.flight.get("interference") or {}
    pairs = [(" – ".join(pair["links"]), pair) for pair in measured.get("bodies", [])]
    pairs += [(f"plume of {pair['jet']} – {pair['link']}", pair) for pair in measured.get("plumes", [])]
    nearest = sorted(pairs, key=lambda named: named[1]["clearance"])[:CLOSEST]
    return [
        f"{name.replace('_', ' ')}: **{pair['clearance'] / MILLIMETER:.1f} mm** at {pair['time']:.1f} s"
        for name, pair in nearest
    ]


def legend(detail: Detail) -> str:
    """The colors of stress as HTML: a scale for each part, which ends at the peak that decides its safety factor."""
    stops = ", ".join(f"{color} {100 * at:g}%" for at, color in zip(STRESS_STOPS, STRESS, strict=True))
    bar = f'<div style="height:8px;border-radius:4px;background:linear-gradient(90deg,{stops})"></div>'
    scales = "".join(
        f'<div style="display:flex;justify-content:space-between"><span>0</span><span>{words(name)}</span>'
        f"<span>{number(part.peak / MEGA, 3)} MPa</span></div>"
        for name, part in detail.parts.items()
    )
    return f'<div style="padding:0 1em;font-size:0.8em">Von Mises stress{bar}{scales}</div>' if scales else ""


def joint_angles(detail: Detail, time: float) -> str:
    """Angle of every joint at a moment, as Markdown."""
    if detail.flight is None:
        return ""
    row = detail.flight["joint_positions"][sample_at(detail.flight, time)]
    return "  \n".join(
        f"{name.replace('_', ' ')}: **{value / DEGREE:.1f}°**"
        for name, value in zip(detail.flight.joints, row, strict=False)
    )
