"""How strong the parts of a design are, load case by load case, for the page, an export and the terminal."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from codesign.problem.quantities import words
from codesign.report.objections import Limits, least_factor, least_frequency
from codesign.units import MEGA, MILLIMETER


@dataclass(frozen=True, slots=True)
class CaseStrength:
    """A part under one of its load cases, SI units.

    name: of the load case. factor: None where nothing is stressed. least: what is asked of it, None: nothing. decides:
    whether it is the case nearest to its limit. place: what to know of where the peak stress lies, "" mostly.
    """

    name: str
    factor: float | None
    least: float | None
    peak: float
    error: float
    decides: bool
    place: str = ""

    @property
    def text(self) -> str:
        """`safety factor 3.94 (at least 1.5), peak stress 70 ± 2.7 MPa`."""
        asked = f" (at least {self.least:g})" if self.least is not None else ""
        stressed = self.factor is not None and math.isfinite(self.factor)
        factor = "not stressed" if not stressed else f"safety factor {self.factor:.3g}{asked}"
        return f"{factor}, peak stress {self.stress}"

    @property
    def stress(self) -> str:
        """The peak stress with its estimated error: `70 ± 2.7 MPa (3.9 %)`."""
        share = f" ({100 * self.error / self.peak:.2g}\u202f%)" if self.peak else ""
        return f"{self.peak / MEGA:.3g} ± {self.error / MEGA:.2g}\u202fMPa{share}"

    def document(self) -> dict[str, Any]:
        """For JSON, SI units."""
        return {
            "load_case": self.name,
            "safety_factor": self.factor,
            "safety_factor_min": self.least,
            "peak_stress": self.peak,
            "stress_error": self.error,
            "decides": self.decides,
            "note": self.place or None,
        }


def case_strengths(name: str, part: Mapping[str, Any], limits: Limits) -> list[CaseStrength]:
    """Every load case of a part as an evaluation has it. limits: as in `ReportData`."""
    governing = part.get("load_case", "")
    cases: Mapping[str, Mapping[str, Any]] = part.get("cases") or {governing: part}
    return [
        CaseStrength(
            case,
            numbers.get("safety_factor"),
            least_factor(name, case, limits),
            numbers["peak_stress"],
            numbers["stress_error"],
            case == governing,
            place_words(numbers),
        )
        for case, numbers in cases.items()
    ]


def strength_words(name: str, part: Mapping[str, Any], limits: Limits, carried: str) -> list[str]:
    """Every load case of a part, the deciding one first, its frequency, and what to know of the deciding place."""
    on = " on a finer mesh" if part.get("confirmed") else ""
    cases = sorted(case_strengths(name, part, limits), key=lambda case: not case.decides)
    several = len(cases) > 1
    told = [
        f"load case {words(case.name).lower()}{', which decides' if case.decides else ''}: {case.text}"
        if several
        else case.text
        for case in cases
    ]
    found = [f"{words(name)}{on}: {'; '.join(told)}"] if told else []
    place = next((case.place for case in cases if case.decides and case.place), "")
    return [*found, *filter(None, (frequency_words(name, part, limits, carried), place[:1].upper() + place[1:]))]


def place_words(numbers: Mapping[str, Any]) -> str:
    """What to know of a peak stress beside a clamp, where a linear elastic model has no finite stress; "" elsewhere.

    numbers: of a part, or of one of its load cases.
    """
    said, hidden = [], numbers.get("left_out")
    if numbers.get("peak_at_exclusion"):
        x, y, z = (value / MILLIMETER for value in numbers["peak_position"])
        said.append(
            f"the peak stress, at ({x:.1f}, {y:.1f}, {z:.1f})\u202fmm, lies {_mm(numbers['border_distance'])} "
            "from the rim of a clamp or load, right beside what is left out there: how near to the rim it is read sets "
            "it, and no mesh settles it"
        )
    if hidden and hidden["stress"] > numbers["peak_stress"]:
        said.append(
            f"{_mm(hidden['border_distance'])} from the rim of a clamp or load the model has "
            f"{hidden['stress'] / MEGA:.3g}\u202fMPa, which grow with every finer mesh and are left out"
        )
    if not said:
        return ""
    return (
        f"{'; '.join(said)}. Hold the part as it is held in truth (faces under screws, a hole in its plane only), "
        "round the edge there, or judge the place by hand"
    )


def _mm(length: float) -> str:
    return f"{length / MILLIMETER:.2g}\u202fmm"


def frequency_words(name: str, part: Mapping[str, Any], limits: Limits, carried: str) -> str:
    """A part's first natural frequency with its limit and with what it carries; "" where it was not computed."""
    frequency = part.get("first_frequency")
    if frequency is None or not math.isfinite(frequency):
        return ""
    least = least_frequency(name, limits)
    asked = f" (at least {least:g}\u202fHz)" if least is not None else ""
    counted = f"counted with it: {carried}" if carried else "nothing that hangs on the part is counted"
    return f"{words(name)}: first natural frequency {frequency:.4g}\u202fHz{asked}; {counted}"
