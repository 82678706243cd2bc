"""The page's first screen: what was optimized, what was gained, which design to build and why."""

from __future__ import annotations

import base64
import shlex
from html import escape

from codesign.problem.design_space import value_text
from codesign.report import recommendation, words
from codesign.report.comparison import shares_in_words
from codesign.report.data import ReportData
from codesign.report.evidence import Evidence, evidence, validated
from codesign.report.validation import Validation
from codesign.report.verdict import run_verdict, watch


def summary(run: ReportData, picture: bytes | None = None, validation: Validation | None = None) -> str:
    """HTML of the first screen; picture: PNG of the robot with the parts that were optimized."""
    leads = [run.description, words.searched(run), words.gained(run), shares_in_words(run)]
    said = f"<h1>{escape(run.title)}</h1>" + "".join(f'<p class="lead">{escape(text)}</p>' for text in leads if text)
    notes = "".join(f'<p class="notice">{escape(note)}</p>' for note in words.caveats(run))
    shown = ""
    if picture is not None:
        source = base64.b64encode(picture).decode()
        shown = (
            f'<figure><img src="data:image/png;base64,{source}" alt="The robot, the optimized parts in blue">'
            "<figcaption>In blue: the parts that were optimized</figcaption></figure>"
        )
    return (
        f'<section class="summary" aria-label="Summary"><div class="opening"><div>{said}{notes}</div>{shown}</div>'
        f"{_tiles(run, validation)}{_build(run)}</section>"
    )


def _tiles(run: ReportData, validation: Validation | None) -> str:
    """One figure an objective: its change from the original, both values, and how far it can be trusted."""
    if run.recommended is None:
        return ""
    known = [evidence(run, validation, k) for k in range(len(run.objectives))]
    tiles = "".join(_tile(run, k, known[k]) for k in range(len(run.objectives)))
    return f'<dl class="tiles">{tiles}</dl><p class="trust">{escape(_trust(run, validation))}</p>'


def _tile(run: ReportData, k: int, known: Evidence) -> str:
    assert run.recommended is not None
    objective = run.objectives[k]
    here = objective.sign * run.values[run.recommended, k]
    gain, baseline, unit = run.gain(run.recommended), run.baseline_vector, escape(objective.unit)
    if gain is None or baseline is None:
        big, change, trust = words.number(here), unit, ""
    else:
        big = words.percent(objective.sign * gain[k])
        change = f"{words.number(objective.sign * baseline[k])} → {words.number(here)} {unit}"
        trust = f"<p>{escape(known.text)}</p>"
    size = "big" if known.sense else "big open"
    return (
        f'<div class="tile" title="{escape(objective.meaning)}"><dt>{escape(objective.label)}</dt>'
        f'<dd class="{size} {known.sense}">{big}</dd><dd><p>{change}</p>{trust}</dd></div>'
    )


def _trust(run: ReportData, validation: Validation | None) -> str:
    """What the changes are of, and how to learn whether they last."""
    flown = run.subject_words.flight
    if run.baseline_vector is None or not run.flies or validated(run, validation):
        return flown
    command = f"codesign validate {shlex.quote(str(run.directory))}"
    return f"{flown} Whether these changes last on other flights is not known: {command}."


def _build(run: ReportData) -> str:
    """The recommended design, why it is recommended, what speaks against it, and the command that exports it."""
    box = '<div class="build" role="group" aria-label="Recommended design">'
    if run.recommended is None:
        text = escape(recommendation.nothing_to_build(run))
        return f'{box}<div><h2 class="bad">No design to build</h2><p>{text}</p></div></div>' if run.front else ""
    entry = run.entries[run.recommended]
    design = entry.evaluation.design
    values = "".join(
        f"<div><dt>{escape(run.label(v))}</dt><dd>{value_text(design[v.name])}{_unit(v.unit)}</dd></div>"
        for v in run.variables
    )
    command = f"{run.export_command} --design {entry.id} --out design-{entry.id}"
    verdict = run_verdict(run, run.recommended)
    points = ""
    if verdict.reasons:
        open_points = "".join(f"<li>{escape(text)}</li>" for text in verdict.reasons)
        points = f'<p class="bad">{verdict.head}:</p><ul class="bad">{open_points}</ul>'
    points += "".join(f'<p class="notice">{escape(text)}</p>' for text in watch(entry.evaluation))
    said = [
        " ".join(verdict.remedies),
        recommendation.why(run),
        f"{recommendation.price(run)} {recommendation.second_opinion(run)}",
        recommendation.strength(run),
        recommendation.load_cases(run),
        recommendation.as_made(run),
        recommendation.clearances(run),
    ]
    paragraphs = "".join(f"<p>{escape(text.strip())}</p>" for text in said if text.strip())
    return (
        f'{box}<h2>{escape(verdict.title)}</h2>{points}<dl class="values">{values}</dl>'
        f'<div class="because">{paragraphs}</div>'
        f'<div class="command"><code>{escape(command)}</code>'
        f'<button type="button" class="copy" data-copy="{escape(command)}">Copy</button></div></div>'
    )


def _unit(unit: str) -> str:
    return "°" if unit == "deg" else f" <small>{escape(unit)}</small>" if unit else ""
