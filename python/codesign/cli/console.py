"""Results as text on a terminal, or as JSON on stdout."""

from __future__ import annotations

import json
import sys
from collections import Counter
from typing import TYPE_CHECKING, Any

from rich.console import Console
from rich.table import Table
from rich.text import Text

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from codesign.followup.tables import Table as PartTable
    from codesign.problem.design_space import DesignValue
    from codesign.problem.evaluation import Evaluation
    from codesign.problem.quantities import Quantity
    from codesign.report.tolerances import Tolerances
    from codesign.storage.records import Record
    from codesign.storage.runs import Run

UNLIMITED = 10_000  # columns of a terminal
MOST_ROWS = 20  # of a front
SPARE = ("seed", "algorithm", "seconds", "study", "outcome")  # columns of a list of runs that give way first
# What is printed holds paths and texts of users: square brackets and colons in them are no markup.
out = Console(markup=False, emoji=False)
err = Console(markup=False, emoji=False, stderr=True)


def print_json(document: Any) -> None:
    """One JSON document on stdout, nothing else."""
    sys.stdout.write(json.dumps(document, indent=1, allow_nan=False) + "\n")


def shown(value: Any, digits: int = 6) -> str:
    """A value of a document as text; None is a number that was not measured, or not finite."""
    if value is None:
        return "-"
    return f"{value:.{digits}g}" if isinstance(value, int | float) and not isinstance(value, bool) else str(value)


def print_evaluation(evaluation: Evaluation) -> None:
    """Text summary of one evaluation."""
    color = {"feasible": "green", "infeasible": "yellow", "skipped": "yellow", "failed": "red"}[evaluation.status]
    out.print(Text.assemble((evaluation.status, f"bold {color}"), f"  {_design_text(evaluation.design)}"))
    if evaluation.reason:
        out.print(evaluation.reason)
    table = Table(show_header=False, box=None, pad_edge=False)
    for group in (evaluation.objectives, evaluation.constraints):
        for key, value in group.items():
            known = _quantity(evaluation, key)
            table.add_row(known.name, known.text(value))
    for name, part in evaluation.parts.items():
        table.add_row(
            name,
            f"{part['mass']:.4f} kg, SF {factor_text(part, 1)}, peak {part['peak_stress'] / 1e6:.2f} MPa"
            f" (± {part['stress_error'] / 1e6:.2f}), left out {left_out_text(part)}",
        )
        cases = part.get("cases", {})
        for case, found in cases.items():
            when = f" at {found['time']:.3f} s, {found['link']}{_life(found)}" if "time" in found else ""
            if when or len(cases) > 1:
                table.add_row("", f"{case}: SF {factor_text(found, 1)}{when}")
        if part.get("peak_at_exclusion"):
            table.add_row(
                "", f"peak {part['border_distance'] * 1e3:.2g} mm from the rim of a clamp or load: see docs/fem.md"
            )
        if not part.get("peak_resolved", True):
            table.add_row("", 'peak not resolved: its error exceeds half of it; set [fem] accuracy = "fine"')
    for key in ("max_com_error", "max_attitude_error", "min_thrust", "max_thrust"):
        if key in evaluation.flight:
            table.add_row(f"flight {key}", shown(evaluation.flight[key], 4))
    table.add_row("seconds", "  ".join(f"{k} {v:.2f}" for k, v in evaluation.seconds.items()))
    out.print(table)


def _design_text(design: Mapping[str, DesignValue]) -> str:
    """Names and values of a design in one line."""
    from codesign.problem.design_space import value_text

    return "  ".join(f"{name}={value_text(value)}" for name, value in design.items())


def _quantity(evaluation: Evaluation, key: str) -> Quantity:
    """What is known of a number of an evaluation; its objectives tell the family that they are of."""
    from codesign.problem.quantities import FAMILY, quantity

    families = evaluation.objective_families.items()
    of = (family for family, values in families if key in FAMILY and values.get(key) == evaluation.objectives.get(key))
    return quantity(key, next(of, "rms"))


def print_verdict(verdict: Mapping[str, Any], only_reasons: bool = False) -> None:
    """Whether a design may be built, as `Verdict.document`. only_reasons: nothing of one that may."""
    if verdict["may_be_built"]:
        if not only_reasons:
            out.print(Text.assemble((verdict["title"], "bold green"), ": nothing that was checked speaks against it"))
            for text in verdict["notes"]:
                out.print(text, soft_wrap=True)
        return
    head = "not to be built" if verdict["kind"] == "barred" else "not to be built yet"
    out.print(Text.assemble((head, "bold yellow"), ": ", " ".join(verdict["reasons"])), soft_wrap=True)
    for text in (*verdict["remedies"], *([] if only_reasons else verdict["notes"])):
        out.print(text, soft_wrap=True)


def print_tolerances(found: Tolerances) -> None:
    """Of every sampled design the share that is feasible, and how its numbers scatter."""
    from codesign.problem.quantities import quantity

    for made in found.designs:
        design = _design_text(made.design)
        verdict = "" if made.robust else "; not to be recommended"
        out.print(f"{made.role}  {design}: {made.feasible} of {made.samples} samples are feasible{verdict}")
        table = Table("", "least", "5 %", "median", "95 %", "largest", box=None, pad_edge=False)
        for name, spread in made.numbers.items():
            known = quantity(name)
            row = sorted(map(known.shown, (spread.least, spread.low, spread.median, spread.high, spread.most)))
            table.add_row(_head(known), *(f"{value:.5g}" for value in row))
        out.print(table)
        for reason in made.reasons:
            out.print(f"  {reason}")


def factor_text(part: Mapping[str, Any], digits: int) -> str:
    """Safety factor of a part; one that is not stressed has none."""
    factor = part["safety_factor"]
    return "none (not stressed)" if factor is None else f"{factor:.{digits}f}"


def _life(case: Mapping[str, Any]) -> str:
    """How many flights fatigue a part, where its material has figures for that."""
    flights = case.get("fatigue", {}).get("flights")
    return "" if flights is None else f", fatigue after {flights:.2g} flights"


def left_out_text(part: Mapping[str, Any]) -> str:
    """The largest stress that the exclusion leaves out, and its distance to the next clamp or border of a load."""
    left_out = part.get("left_out")
    if left_out is None:
        return "none"
    return f"{left_out['stress'] / 1e6:.2f} MPa, {left_out['border_distance'] * 1e3:.1f} mm from a border"


def print_run(run: Run, as_json: bool) -> int:
    """Summary of a run and its front, or of what comes nearest to one; exit code 1 if nothing is feasible."""
    from codesign.problem.evaluation import least_infeasible
    from codesign.storage.runs import summarize

    summary = summarize(run)
    front = run.front
    if as_json:
        closest = None if front else least_infeasible(run.evaluations)
        print_json(
            summary
            | {"front": [record.evaluation.to_dict() for record in front]}
            | ({} if front else {"least_infeasible": None if closest is None else closest.to_dict()})
        )
        return 0 if front else 1
    counts = "  ".join(f"{status} {count}" for status, count in summary["statuses"].items())
    told = f": {summary['designs']} designs ({counts}) in {summary['seconds']:.1f} s"
    out.print(Text.assemble((str(run.out), "bold"), told))
    if run.missing:
        planned = summary["designs"] + run.missing
        why = f" ({run.outcome})" if run.outcome else ""
        out.print(f"{run.missing} of {planned} evaluations are missing{why}: codesign resume {run.out}", soft_wrap=True)
    if front:
        _print_front(front)
        return 0
    _print_nothing_feasible(run.evaluations)
    return 1


def print_runs(rows: Sequence[Mapping[str, Any]], last: Sequence[str]) -> None:
    """A line for each run; columns without a value, and those that a narrow terminal has no room for, are left out."""
    wanted = ["run", "study", "algorithm", "seed", "designs", "front", "hypervolume", "best", *last]
    columns = [name for name in wanted if any(row.get(name) is not None for row in rows)]
    table = _runs_table(rows, columns)
    for name in SPARE:
        if out.measure(table, options=out.options.update(width=UNLIMITED)).maximum <= out.width:
            break
        columns = [column for column in columns if column != name]
        table = _runs_table(rows, columns)
    out.print(table)


def _runs_table(rows: Sequence[Mapping[str, Any]], columns: Sequence[str]) -> Table:
    table = Table()
    for name in columns:
        table.add_column(name, overflow="fold")
    for row in rows:
        values = ["" if (value := row.get(name)) is None else value for name in columns]
        table.add_row(*(f"{v:.5g}" if isinstance(v, float) else str(v) for v in values))
    return table


def print_tables(tables: Sequence[PartTable], as_json: bool) -> int:
    """What tables of parts hold; exit code 1 if a part could not be analyzed."""
    rows = [_table_row(table) for table in tables]
    if as_json:
        print_json(rows)
        return 1 if any(row["failed"] for row in rows) else 0
    summary = Table("part", "variables", "designs", "failed", "least safety factor", "mass, kg")
    for row in rows:
        masses = f"{shown(row['least_mass'], 4)} to {shown(row['largest_mass'], 4)}"
        numbers = (str(row["designs"]), str(row["failed"]), shown(row["least_safety_factor"], 4), masses)
        summary.add_row(row["part"], ", ".join(row["variables"]), *numbers)
    out.print(summary)
    for row in rows:
        out.print(f"{row['part']}: {row['run'] or row['reason']}", soft_wrap=True)
    return 1 if any(row["failed"] for row in rows) else 0


def _table_row(table: PartTable) -> dict[str, Any]:
    evaluations = table.run.evaluations if table.run is not None else []
    found = [evaluation.parts[table.part] for evaluation in evaluations if evaluation.status == "feasible"]
    factors = [part["safety_factor"] for part in found if part["safety_factor"] is not None]
    masses = [part["mass"] for part in found]
    return {
        "part": table.part,
        "variables": list(table.variables),
        "designs": len(evaluations),
        "failed": len(evaluations) - len(found),
        "least_safety_factor": min(factors, default=None),
        "least_mass": min(masses, default=None),
        "largest_mass": max(masses, default=None),
        "run": None if table.run is None else str(table.run.out),
        "reason": table.reason,
    }


def _print_front(front: Sequence[Record]) -> None:
    """The best compromises; without their variables where the terminal has no room for them."""
    rows = sorted(front, key=lambda record: list(record.evaluation.objectives.values()))
    table = _front_table(rows, list(rows[0].evaluation.design))
    wanted = out.measure(table, options=out.options.update(width=UNLIMITED)).maximum
    out.print(table if wanted <= out.width else _front_table(rows, []))
    if len(rows) > MOST_ROWS:
        out.print(f"… and {len(rows) - MOST_ROWS} more")


def _front_table(rows: Sequence[Record], variables: Sequence[str]) -> Table:
    """Number in the run, some of the variables, objectives, smallest safety factor of all parts."""
    from codesign.problem.design_space import value_text

    table = Table(title=f"Pareto front, {len(rows)} designs", title_justify="left")
    known = [_quantity(rows[0].evaluation, key) for key in rows[0].evaluation.objectives]
    for name in ("design", *variables, *map(_head, known), "safety_factor"):
        table.add_column(name, justify="right")
    for record in rows[:MOST_ROWS]:
        evaluation = record.evaluation
        factors = [part["safety_factor"] for part in evaluation.parts.values() if part.get("safety_factor") is not None]
        values = zip(known, evaluation.objectives.values(), strict=True)
        numbers = (*(each.shown(value) for each, value in values), min(factors, default=None))
        chosen = (value_text(evaluation.design[name]) for name in variables)
        table.add_row(str(record.number), *chosen, *(shown(number, 5) for number in numbers))
    return table


def _head(known: Quantity) -> str:
    """What a quantity is called, with its unit, for tables."""
    return f"{known.name} [{known.unit}]" if known.unit else known.name


def _print_nothing_feasible(evaluations: Sequence[Evaluation]) -> None:
    """The least infeasible design and what it violates; if all failed, the commonest reason."""
    from codesign.problem.evaluation import least_infeasible

    closest = least_infeasible(evaluations)
    if closest is not None:
        design = _design_text(closest.design)
        out.print(Text.assemble(("nothing is feasible", "bold yellow"), f"; the least infeasible design: {design}"))
        out.print(closest.reason or "", soft_wrap=True)
        for name, violation in closest.violations.items():
            if violation > 0.0:
                out.print(f"{name} violated by {violation:.4g} of its limit")
    elif reasons := Counter(evaluation.reason for evaluation in evaluations if evaluation.reason):
        reason, count = reasons.most_common(1)[0]
        out.print(f"all {len(evaluations)} designs failed, {count} of them: {reason}", soft_wrap=True)


def print_diagnosis(report: dict[str, Any]) -> None:
    """What `codesign doctor` found: facts as a table, then a line for each problem."""
    table = Table(show_header=False, box=None, pad_edge=False)
    for key, value in report.items():
        if key == "problems":
            continue
        if isinstance(value, dict):
            for name, item in value.items():
                table.add_row(f"{key} {name}", str(item))
        else:
            table.add_row(key, ", ".join(value) if isinstance(value, list) else str(value))
    out.print(table)
    for kind, names in report["problems"].items():
        for name in names:
            out.print(Text.assemble((kind, "bold red"), f": {name}"), soft_wrap=True, highlight=False)
