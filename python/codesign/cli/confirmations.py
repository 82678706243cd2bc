"""What people see of confirmed parts: of a design (`evaluate --confirm`), and of designs of a run (`confirm`)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from rich.table import Table

from codesign.cli.console import factor_text, left_out_text, out, print_verdict

if TYPE_CHECKING:
    from codesign.followup.confirmation import Confirmed
    from codesign.parts.strength import Confirmation
    from codesign.problem.evaluation import Evaluation
    from codesign.report.data import ReportData

SETTLED = {True: "settled", False: "not resolved"}
YES = {True: "yes", False: "no", None: "-"}  # below a head that says of what


def print_confirmed(run: ReportData, found: Sequence[Confirmed]) -> None:
    """Designs of a run before and after their confirmation, and which one is recommended now."""
    from codesign.report.verdict import run_verdict

    heads = ("design", "part", "load case", "safety factor", "error", "finer mesh", "error", "change", "settled")
    table = Table(*heads, box=None, pad_edge=False)
    steps = []
    for each in found:
        if not each.found.parts:
            out.print(f"design {each.number} could not be confirmed: {each.found.reason}", soft_wrap=True)
        for name, part in each.found.parts.items():
            for case, numbers in part["cases"].items():
                before = each.evaluation.parts[name].get("cases", {}).get(case, each.evaluation.parts[name])
                cells = (text for one in (before, numbers) for text in (factor_text(one, 2), _error(one)))
                table.add_row(str(each.number), name, case, *cells, _change(numbers), YES[numbers.get("settled")])
                if numbers.get("next_step"):
                    steps.append(f"design {each.number}, {name}, {case}: {numbers['next_step']}")
    out.print(table)
    for step in steps:
        out.print(step, soft_wrap=True, highlight=False)
    if run.recommended is None:
        out.print("the report recommends no design", soft_wrap=True)
        return
    print_verdict(run_verdict(run, run.recommended).document())


def print_confirmations(evaluation: Evaluation, confirmations: Mapping[str, Confirmation]) -> None:
    """Analyzed and confirmed numbers of each part side by side, then its load cases."""
    for name, confirmation in confirmations.items():
        table = Table("", "as analyzed", "full, fine mesh", title=name, title_justify="left", box=None, pad_edge=False)
        both = (confirmation.analyzed, confirmation.confirmed)
        table.add_row("decides", *(part["load_case"] for part in both))
        table.add_row("safety factor", *(factor_text(part, 2) for part in both))
        stresses = (f"{part['peak_stress'] / 1e6:.2f} ± {part['stress_error'] / 1e6:.2f}" for part in both)
        table.add_row("peak stress [MPa]", *stresses)
        table.add_row("largest stress left out", *(left_out_text(part) for part in both))
        table.add_row("stress in 50 mm³ [MPa]", *(f"{part['stress_50'] / 1e6:.2f}" for part in both))
        table.add_row("largest displacement [mm]", *(f"{part['max_displacement'] * 1e3:.4f}" for part in both))
        table.add_row("refinements", "", str(confirmation.confirmed.get("refinements", 0)))
        table.add_row("tetrahedra", *(str(part["tetrahedra"]) for part in both))
        table.add_row("seconds", *(f"{sum(part['seconds'].values()):.1f}" for part in both))
        out.print(table)
        _print_cases(confirmation, list(evaluation.parts[name].get("cases", {})))


def _print_cases(confirmation: Confirmation, searched: Sequence[str]) -> None:
    """Safety factor of every load case as searched and as confirmed; what else to do where it is not settled."""
    table = Table("load case", "searched", "confirmed", "difference", "change", "error", "", box=None, pad_edge=False)
    cases = confirmation.cases
    for case, found in cases.items():
        factors = [found[each]["safety_factor"] for each in ("searched", "confirmed")]
        share = "-" if None in factors else f"{100 * (factors[1] / factors[0] - 1):+.1f} %"
        shown = (factor_text(found["searched"], 2), factor_text(found["confirmed"], 2), share)
        table.add_row(case, *shown, _change(found), _error(found["confirmed"]), SETTLED[found["settled"]])
    for case in searched:
        if case not in cases:
            table.add_row(case, "", "", "", "", "", "not confirmed: its loads are those of the flight")
    out.print(table)
    for case, found in cases.items():
        if found["next_step"]:
            out.print(f"{case}: {found['next_step']}", soft_wrap=True, highlight=False)


def _change(case: Mapping[str, Any]) -> str:
    """Change of the peak by the last refinement there; old rows of a run do not know it."""
    change = case.get("change")
    return "-" if change is None else f"{100 * change:.1f} %"


def _error(numbers: Mapping[str, Any]) -> str:
    from codesign.report.objections import error_share

    share = error_share(numbers)
    return "-" if share is None else f"{100 * share:.1f} %"
