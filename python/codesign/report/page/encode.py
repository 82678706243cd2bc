"""Details as the page carries them: coordinates and stresses as 16-bit integers, histories as 32-bit floats, base64."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from codesign.report.details import Detail, FlightHistory, StressField
from codesign.units import DEGREE, MILLIMETER

LEVELS = 65535


def encoded(values: NDArray[Any], kind: str) -> str:
    """Little-endian bytes of an array (any shape) as base64."""
    return base64.b64encode(np.ascontiguousarray(values, dtype=f"<{kind}").tobytes()).decode()


def page_detail(detail: Detail) -> dict[str, Any]:
    """JSON value of one design's fields and histories."""
    return {
        "parts": {name: _solid(part) for name, part in detail.parts.items()},
        "flight": None if detail.flight is None else _flight(detail.flight),
    }


def _solid(part: StressField) -> dict[str, Any]:
    """Coordinates in mm in 65536 steps over the longest side; stress in 65536 steps up to the part's highest."""
    low = part.points.min(axis=0)
    step = float((part.points.max(axis=0) - low).max()) / LEVELS
    wide = len(part.points) > LEVELS
    highest = max(float(part.von_mises.max()), 1e-30)
    return {
        "points": encoded(np.rint((part.points - low) / step), "u2"),
        "faces": encoded(part.triangles, "u4" if wide else "u2"),
        "stress": encoded(np.rint(np.clip(part.von_mises / highest, 0.0, 1.0) * LEVELS), "u2"),
        "wide": wide,
        "low": [round(float(x) / MILLIMETER, 4) for x in low],
        "step": step / MILLIMETER,
        "highest": highest,
        "peak": min(part.peak, highest),
    }


def _flight(flight: FlightHistory) -> dict[str, Any]:
    """The charts of one flight, in the units that people read."""

    def chart(label: str, unit: str, values: NDArray[Any], names: Sequence[str], zero: bool = True) -> dict[str, Any]:
        columns = values.reshape(len(values), -1)
        series = [{"label": name, "values": encoded(columns[:, i], "f4")} for i, name in enumerate(names)]
        return {"label": label, "unit": unit, "zero": zero, "series": series}

    groups = [group.replace("_", " ") for group in flight.groups]
    charts = [
        chart("Tracking error", "cm", 100.0 * flight["com_error"], ["center of mass"]),
        chart("Attitude error", "°", flight["attitude_error"] / DEGREE, ["base"]),
        chart("Thrusts", "N", flight["thrust"], short_names(flight.jets), zero=False),
    ]
    if groups:  # without a weighted joint group there is no joint velocity to show
        charts.append(chart("Joint velocity error", "°/s", flight["joint_velocity_error"] / DEGREE, groups))
    return {
        "trajectory": flight.trajectory,
        "time": {"label": "time", "values": encoded(flight["time"], "f4")},
        "charts": charts,
    }


def short_names(names: tuple[str, ...]) -> list[str]:
    """Frame names without the words that all of them share: `l_arm_jet_turbine` -> `l arm`."""
    words = [name.split("_") for name in names]
    shared = set(words[0]).intersection(*words[1:]) if len(words) > 1 else set()
    return [" ".join(w for w in each if w not in shared) for each in words]
