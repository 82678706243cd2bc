"""The table of `codesign tune`, its JSON document, and the lines of study.toml that it recommends."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import msgspec
from rich.table import Table

from codesign.cli.console import out
from codesign.units import DEGREE

if TYPE_CHECKING:
    from codesign.chain.tuning import Trial

COLUMNS = (
    "position\nrad/s", "attitude\nrad/s", "linear\nP, D, momentum", "attitude\nP, D", "flight", "momentum\nerror",
    "position\nerror m", "attitude\nerror °", "thrust\nrate", "largest\nthrust N",
)  # fmt: skip


def tuning_document(trials: list[Trial], chosen: Trial | None) -> dict[str, Any]:
    """All trials and the recommended gains, SI units; poles as pairs of real and imaginary part."""
    return {
        "trials": [
            {
                "position": trial.position,
                "attitude": trial.attitude,
                "gains": msgspec.to_builtins(trial.gains),
                "poles": {name: [[p.real, p.imag] for p in poles] for name, poles in trial.poles.items()},
                "momentum": trial.momentum,
                "flight": trial.flight,
            }
            for trial in trials
        ],
        "recommended": None if chosen is None else msgspec.to_builtins(chosen.gains),
    }


def print_tuning(trials: list[Trial], chosen: Trial | None) -> None:
    """One row a trial; * marks the recommended one, whose lines of study.toml follow."""
    table = Table(*COLUMNS, box=None, pad_edge=False, header_style="bold")
    for trial in trials:
        table.add_row(*_row(trial, trial is chosen))
    out.print(table)
    if not trials[0].completed:
        out.print(f"the study's own gains: {trials[0].outcome}", highlight=False)
    if chosen is None:
        out.print("all flights were lost: more thrust, less weight or a calmer trajectory may help", highlight=False)
    elif chosen is trials[0]:
        out.print("the study's own gains are the best of these")
    else:
        out.print("\n[flight.gains]", markup=False)
        for name, value in msgspec.to_builtins(chosen.gains).items():
            out.print(f"{name} = {value!r}", markup=False, highlight=False)


def _row(trial: Trial, chosen: bool) -> list[str]:
    gains, flight = trial.gains, trial.flight
    linear = (gains.linear_proportional, gains.linear_derivative, gains.linear_momentum)
    turning = (gains.attitude_proportional, gains.attitude_derivative)
    lasted = "completed" if trial.completed else f"lost at {flight['failure_time']:.2f} s"
    return [
        ("own" if trial.position is None else f"{trial.position:g}") + ("*" if chosen else ""),
        "own" if trial.attitude is None else f"{trial.attitude:g}",
        ", ".join(f"{value:.3g}" for value in linear),
        ", ".join(f"{value:.3g}" for value in turning),
        lasted,
        "" if trial.momentum is None or not trial.completed else f"{trial.momentum:.3g}",
        _number(flight["max_com_error"], 1.0),
        _number(flight["max_attitude_error"], 1.0 / DEGREE),
        f"{flight['saturation']['thrust_rate_share']:.0%}",
        _number(flight["max_thrust"], 1.0),
    ]


def _number(value: float | None, factor: float) -> str:
    return "" if value is None else f"{factor * value:.3g}"
