"""The validation on the page: tables in HTML, points for the chart."""

from __future__ import annotations

from html import escape
from typing import Any

import numpy as np

from codesign.problem.quantities import Quantity, words
from codesign.report.data import ReportData
from codesign.report.validation import ORIGINAL, Validation
from codesign.report.words import number, percent


def strips(run: ReportData, validation: Validation | None) -> dict[str, Any] | None:
    """Points of the chart: for each objective, the changes of every design's calm and disturbed flights."""
    if validation is None:
        return None
    roles = [role for role in validation.roles if role != ORIGINAL]

    def points(objective: Quantity, disturbed: bool) -> list[dict[str, Any]]:
        return [
            {"role": x, "flight": f"{role}, {_flight(case)}", "change": round(objective.sign * change, 6)}
            for x, role in enumerate(roles)
            for case, change in validation.change(role, objective.key, disturbed).items()
        ]

    objectives = [{"label": o.label, "calm": points(o, False), "disturbed": points(o, True)} for o in run.objectives]
    return {"roles": roles, "objectives": objectives}


def _flight(case: tuple[str, int | None]) -> str:
    trajectory, seed = case
    return words(trajectory) + (f", seed {seed}" if seed is not None else "")


def validation_tables(run: ReportData, validation: Validation) -> str:
    """Mean change of each design over all trajectories; below, folded, every calm flight in numbers."""
    return _changes(run, validation) + _flights(run, validation)


def _changes(run: ReportData, validation: Validation) -> str:
    disturbed = any(flight.seed is not None for flight in validation.flights)
    kinds = [False, True] if disturbed else [False]
    heads = ['<th scope="col">Design</th>', '<th scope="col">Flights<br>completed</th>']
    for objective in run.objectives:
        for wild in kinds:
            kind = f"<br>{'disturbed' if wild else 'calm'}" if disturbed else ""
            heads.append(f'<th scope="col">{escape(objective.label)}{kind}</th>')
    rows = []
    for role in validation.roles:
        flown = validation.of(role)
        cells = [f"<td>{escape(words(role))}</td>", f"<td>{sum(f.completed for f in flown)} of {len(flown)}</td>"]
        for objective in run.objectives:
            noise = validation.noise(role, objective.key)
            changes = [list(validation.change(role, objective.key, wild).values()) for wild in kinds]
            cells += [_change_cell(of_kind, noise, objective.sign) for of_kind in changes]
        if role != ORIGINAL:
            rows.append(f"<tr>{''.join(cells)}</tr>")
        else:
            rows.append(f'<tr>{cells[0]}{cells[1]}<td colspan="{len(cells) - 2}"></td></tr>')
    return (
        '<div class="sideways"><table class="figures"><caption class="count">Mean change from the original over all '
        "flights that both completed; below it, the least and the greatest. A tie: a mean change within two standard "
        f"errors of the disturbed flights, paired by seed.</caption><thead><tr>{''.join(heads)}</tr>"
        f"</thead><tbody>{''.join(rows)}</tbody></table></div>"
    )


def _change_cell(changes: list[float], noise: float | None, sign: float = 1.0) -> str:
    """Mean, least and greatest change; one within the noise of paired seeds is a tie.

    changes: of the number of which less is better; sign: from them to what people read.
    """
    if not changes:
        return "<td>–</td>"
    mean = float(np.mean(changes))
    if noise is not None and abs(mean) <= noise:
        return f"<td>tie<small>{percent(sign * mean)}, chance ± {100 * noise:.1f}\u202f%</small></td>"
    sense = "good" if mean < -5e-4 else "bad" if mean > 5e-4 else ""
    low, high = sorted((sign * min(changes), sign * max(changes)))
    ends = f"{percent(low)} … {percent(high)}"
    return f'<td><span class="{sense}">{percent(sign * mean)}</span><small>{ends}</small></td>'


def _flights(run: ReportData, validation: Validation) -> str:
    """Every calm flight: objectives of each design on each trajectory."""
    calm = {(f.role, f.trajectory): f for f in validation.flights if f.seed is None}
    heads = "".join(f'<th scope="col">{escape(words(role))}</th>' for role in validation.roles)
    rows = []
    for trajectory in validation.trajectories:
        for objective in run.objectives:
            cells = []
            for role in validation.roles:
                flight = calm.get((role, trajectory))
                value = flight.objectives.get(objective.key) if flight is not None else None
                cells.append(f"<td>{number(objective.shown(value)) if value is not None else 'lost'}</td>")
            rows.append(f"<tr><td>{escape(words(trajectory))}: {escape(objective.title)}</td>{''.join(cells)}</tr>")
    return (
        '<details><summary>All calm flights in numbers</summary><div class="sideways"><table class="figures">'
        f'<thead><tr><th scope="col">Trajectory and objective</th>{heads}</tr></thead>'
        f"<tbody>{''.join(rows)}</tbody></table></div></details>"
    )
