"""Table of what a run's designs have of each constraint."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rich.table import Table

from codesign.cli.console import out
from codesign.problem.quantities import quantity

if TYPE_CHECKING:
    from codesign.followup.other_study import Extremes

DIGITS = 4


def print_extremes(found: Sequence[Extremes]) -> None:
    """Least and most of each constraint, and the design that is nearest to its limit or misses it most."""
    table = Table("constraint", "least", "most", "smallest margin", "of design")
    for each in found:
        known = quantity(each.key)
        values = (known.text(value, DIGITS) for value in (each.least, each.most))
        table.add_row(known.label, *values, f"{100 * each.margin:+.1f} %", str(each.tightest))
    out.print(table)
