"""A slider for each design variable and what a model of the run's designs predicts there, beside the scene."""

from __future__ import annotations

from typing import Any

import numpy as np

from codesign.problem.design_space import value_text
from codesign.report.data import ReportData
from codesign.report.page.what_if import shown_quantity
from codesign.report.words import number
from codesign.surrogate.what_if import Prediction, WhatIf

SURE = 0.95  # chance of a result below which it is told


class WhatIfPanel:
    """The folder "What if" of the viewer's controls.

    server: viser's. run: the designs. models: made of them.
    """

    def __init__(self, server: Any, run: ReportData, models: WhatIf) -> None:
        self._run, self._models = run, models
        start = run.recommended if run.recommended is not None else models.entries[0]
        grid = run.space.indices(run.entries[start].evaluation.design)
        with server.gui.add_folder("What if", expand_by_default=False):
            self._sliders = [
                server.gui.add_slider(run.label(variable), 0, max(1, variable.levels - 1), 1, index)
                for variable, index in zip(run.variables, grid, strict=True)
            ]
            self._text = server.gui.add_markdown("")
        for slider in self._sliders:
            slider.on_update(lambda _: self.update())
        self.update()

    @property
    def text(self) -> str:
        """What is said of the design that the sliders stand on, as Markdown."""
        return str(self._text.content)

    def set(self, grid: tuple[int, ...]) -> None:
        """Puts the sliders on a design, by its grid indices."""
        for slider, index in zip(self._sliders, grid, strict=True):
            slider.value = index
        self.update()

    def update(self) -> None:
        """Predicts the design that the sliders stand on."""
        levels = self._run.space.levels
        grid = tuple(min(int(slider.value), n - 1) for slider, n in zip(self._sliders, levels, strict=True))
        self._text.content = said(self._run, self._models, grid)


def said(run: ReportData, models: WhatIf, grid: tuple[int, ...]) -> str:
    """A design's predictions with their 90 % bands, warnings, and the nearest evaluated design, as Markdown."""
    design = run.space.from_indices(grid)
    lines = [
        ", ".join(f"{run.label(v)} **{value_text(design[v.name])}** {v.unit}".strip() for v in run.variables),
    ]
    if not models.inside(grid):
        lines.append("**Outside of all designs with a result: only means are shown, and they may be far off.**")
    chance = models.completes(grid)
    if chance < SURE:
        lines.append(f"**Chance that it gives a result at all: {100 * chance:.0f} %**")
    errors = {model.key: model.quality for model in models.numbers}
    for key, prediction in models.predict(grid).items():
        lines.append(_line(run, key, prediction, errors[key].error, errors[key].poor))
    entry, steps = models.nearest(grid)
    where = "evaluated as" if steps == 0 else f"{steps} grid steps from"
    return "\n\n".join([*lines, f"{where} design {run.entries[entry].id}; a prediction, no evaluation"])


def _line(run: ReportData, key: str, prediction: Prediction, error: float, poor: bool) -> str:
    shown = shown_quantity(run, key)
    band = ""
    if prediction.bands:
        low, high = (number(end) for end in sorted(map(shown.shown, prediction.bands[-1])))
        band = f" (90 %: {low} … {high})"
    limit = ""
    if key in run.limits and key not in run.keys:
        sign, least = run.limits[key]
        limit = f", limit {sign} {np.round(shown.shown(least), 9):g}"
    trust = " **unreliable**" if poor else ""
    return (
        f"{shown.label}: **{number(shown.shown(prediction.mean))}** {shown.unit}{band}{limit}; "
        f"leave-one-out {100 * error:.2g} % of the spread{trust}"
    )
