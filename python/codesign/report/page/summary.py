"""The page's first screen: what was optimised, what was gained, which design to build and why."""

from __future__ import annotations

import base64
from html import escape

from codesign.report import words
from codesign.report.data import ReportData


def summary(run: ReportData, picture: bytes | None = None) -> str:
    """HTML of the first screen; picture: PNG of the robot with the parts that were optimised."""
    leads = [run.description, words.searched(run), words.gained(run)]
    said = f"<h1>{escape(run.title)}</h1>" + "".join(f'<p class="lead">{escape(text)}</p>' for text in leads if text)
    notes = "".join(f'<p class="notice">{escape(note)}</p>' for note in words.caveats(run))
    shown = ""
    if picture is not None:
        source = base64.b64encode(picture).decode()
        shown = (
            f'<figure><img src="data:image/png;base64,{source}" alt="The robot, the optimised parts in blue">'
            "<figcaption>In blue: the parts that were optimised</figcaption></figure>"
        )
    return (
        f'<section class="summary" aria-label="Summary"><div class="opening"><div>{said}{notes}</div>{shown}</div>'
        f"{_tiles(run)}{_build(run)}</section>"
    )


def _tiles(run: ReportData) -> str:
    """One figure an objective: its change from the original, and both values."""
    if run.recommended is None:
        return ""
    gain, baseline = run.gain(run.recommended), run.baseline_vector
    tiles = []
    for k, objective in enumerate(run.objectives):
        here, unit = run.values[run.recommended, k], escape(objective.unit)
        if gain is None or baseline is None:
            big, change = words.number(here), unit
        else:
            sense = "" if abs(gain[k]) < words.EQUAL else "good" if gain[k] < 0 else "bad"
            big = f'<span class="{sense}">{words.percent(gain[k])}</span>'
            change = f"{words.number(baseline[k])} → {words.number(here)} {unit}"
        tiles.append(
            f'<div class="tile" title="{escape(objective.meaning)}"><dt>{escape(objective.label)}</dt>'
            f'<dd class="big">{big}</dd><dd><p>{change}</p></dd></div>'
        )
    return f'<dl class="tiles">{"".join(tiles)}</dl>'


def _build(run: ReportData) -> str:
    """The recommended design, why it is recommended, and the command that exports it."""
    if run.recommended is None:
        return ""
    entry = run.entries[run.recommended]
    design = entry.evaluation.design
    values = "".join(
        f"<div><dt>{escape(run.label(v))}</dt><dd>{design[v.name]:g}{_unit(v.unit)}</dd></div>" for v in run.variables
    )
    command = " ".join(
        [run.export_command, *(f"--set {v.name}={design[v.name]:g}" for v in run.variables), f"--out design-{entry.id}"]
    )
    return (
        f'<div class="build" role="group" aria-label="Recommended design"><div><h2>Build design {entry.id}</h2>'
        f"<p>{escape(words.why(run))}</p><p>{escape(words.price(run))} {escape(words.strength(run))}</p></div>"
        f'<dl class="values">{values}</dl><div class="command"><code>{escape(command)}</code>'
        f'<button type="button" class="copy" data-copy="{escape(command)}">Copy</button></div></div>'
    )


def _unit(unit: str) -> str:
    return "°" if unit == "deg" else f" <small>{escape(unit)}</small>" if unit else ""
