"""Figures of a flight: errors, thrusts and the controller's work over time, under the pilot's commands."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import Any

import numpy as np

from codesign.chain.flight import find_trajectory
from codesign.report.details import FlightHistory
from codesign.report.figures import style
from codesign.report.figures.data import FigureData
from codesign.report.page.encode import short_names
from codesign.units import DEGREE

SMALL = 6.5  # font size of commands [points]
WIDTH = 5.0  # of the time axis, at least [inches]
LEGEND = 18  # letters a line
COMMANDS = ("forward", "left", "up", "roll", "pitch", "yaw")
NEGATIVE = {"forward": "back", "left": "right", "up": "down"}


def histories(data: FigureData) -> Any:
    """Time histories of the recommended design (or the original), with the original's errors for comparison."""
    from matplotlib.figure import Figure

    flights = {name: detail.flight for name, e in data.compared.items() if (detail := data.detail(e)) and detail.flight}
    if not flights:
        return None
    main = flights.get("recommended") or flights["original"]
    other = flights["original"] if "recommended" in flights else None
    figure = Figure(figsize=(style.PAGE, 7.0))
    rows = figure.subplots(5, 1, sharex=True)
    _error(rows[0], main, other, "com_error", 100.0, "tracking\nerror (cm)")
    _error(rows[1], main, other, "attitude_error", 1.0 / DEGREE, "attitude\nerror (°)")
    for i, name in enumerate(short_names(main.jets)):
        dash = "-" if i < len(style.SERIES) else ":"
        label = textwrap.fill(name, LEGEND)
        rows[2].plot(main["time"], main["thrust"][:, i], dash, color=style.SERIES[i % len(style.SERIES)], label=label)
    rows[2].set_ylabel("thrust (N)")
    for i, name in enumerate(main.groups):
        error = main["joint_velocity_error"][:, i] / DEGREE
        rows[3].plot(
            main["time"],
            error,
            color=style.SERIES[i % 4],
            label=textwrap.fill(name.replace("_", " "), LEGEND),
            linewidth=0.9,
        )
    rows[3].set_ylabel("joint velocity\nerror (°/s)")
    rows[4].plot(
        main["time"], main["active_bounds"], color=style.BLUE, label="active bounds of\nthe momentum QP", linewidth=0.9
    )
    rows[4].plot(main["time"], main["qp_iterations"][:, 0], color=style.ORANGE, label="factorizations", linewidth=0.9)
    rows[4].set(ylabel="QP", xlabel="time (s)", xlim=(0.0, main["time"][-1]))
    for axes in rows:
        if axes.get_legend_handles_labels()[0]:
            axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
        _mark_commands(axes, data.study, main.trajectory, words=axes is rows[0])
    figure.align_ylabels(rows)
    return figure


def _error(axes: Any, main: FlightHistory, other: FlightHistory | None, key: str, factor: float, label: str) -> None:
    if other is not None:
        axes.plot(
            other["time"], factor * other[key], color=style.ORIGINAL, linewidth=0.9, linestyle="--", label="original"
        )
    axes.plot(
        main["time"], factor * main[key], color=style.BLUE, label="recommended" if other is not None else "original"
    )
    axes.set_ylabel(label)
    axes.set_ylim(bottom=0.0)


def _mark_commands(axes: Any, study: Any, trajectory: str, words: bool) -> None:
    """Shades the time windows in which the pilot commands something, and names the commands."""
    windows = find_trajectory(study.config, trajectory).windows if study is not None else []
    for window in windows:
        axes.axvspan(window.from_s, window.to_s, color="#f1f1ee", linewidth=0, zorder=0)
    if words:
        named = [((window.from_s + window.to_s) / 2.0, command(window)) for window in windows]
        for (middle, text), level in zip(named, _levels(named, axes.get_xlim()[1]), strict=True):
            axes.annotate(
                text, (middle, 1.0), (0.0, 2.0 + 1.25 * SMALL * level), xycoords=axes.get_xaxis_transform(),
                textcoords="offset points", ha="center", va="bottom", fontsize=SMALL,
            )  # fmt: skip


def _levels(named: Sequence[tuple[float, str]], duration: float) -> list[int]:
    """Line, counted upwards, on which each of some words at times [s] is written: none touches the one before."""
    letter = duration * style.LETTER * SMALL / (72.0 * WIDTH)
    ends: list[float] = []
    found = []
    for middle, text in named:
        half = letter * (len(text) + 1) / 2.0
        level = next((k for k, end in enumerate(ends) if end <= middle - half), len(ends))
        ends[level : level + 1] = [middle + half]
        found.append(level)
    return found


def command(window: Any) -> str:
    """A command window in words: `up, yaw left`."""
    found = []
    for name in COMMANDS:
        sign = getattr(window, name)
        if sign and name == "yaw":
            found.append("yaw left" if sign > 0 else "yaw right")
        elif sign:
            found.append(name if sign > 0 else NEGATIVE.get(name, f"−{name}"))
    return ", ".join(found)


def sample_at(flight: FlightHistory, time: float) -> int:
    """Row of a history nearest to a time [s]."""
    return int(np.argmin(np.abs(flight["time"] - time)))
