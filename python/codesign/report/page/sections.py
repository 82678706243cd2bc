"""The page's sections after the first screen; charts, card and table are filled by the script."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape

from codesign.problem.quantities import words as spelled
from codesign.report.data import ReportData, reasons
from codesign.report.page.comparison import comparison_table, key_of_runs
from codesign.report.page.validation import validation_tables
from codesign.report.page.what_if import section_text
from codesign.report.validation import Validation
from codesign.report.words import better_side
from codesign.surrogate.what_if import WhatIf

SHOWN_IDS = 8  # of designs that share a reason
ANNOUNCEMENT = '<p id="announcement" role="status" aria-live="polite" class="skip"></p>'
CARD = '<aside class="card" id="card" aria-label="Selected design"></aside>'
KEY = {
    "recommended": '<path d="M7 0l2 4.8 5 .4-3.8 3.3 1.2 5L7 10.8l-4.4 2.7 1.2-5L0 5.2l5-.4z" fill="var(--ink)"/>',
    "best compromise": '<circle cx="7" cy="7" r="5" fill="#21918c"/>',
    "best compromise, not to be built": '<circle cx="7" cy="7" r="4.5" fill="none" stroke="#21918c" stroke-width="2"/>',
    "feasible": '<circle cx="7" cy="7" r="3" fill="var(--dot)"/>',
    "infeasible": '<path d="M4 4l6 6M10 4l-6 6" stroke="var(--faint)" stroke-width="1.3"/>',
    "original": '<path d="M7 0l7 7-7 7-7-7z" fill="var(--original)"/>',
}


@dataclass(frozen=True, slots=True)
class Block:
    """A section: anchor, name in the navigation, HTML."""

    key: str
    short: str
    html: str


def sections(run: ReportData, validation: Validation | None = None, models: WhatIf | None = None) -> list[Block]:
    """The sections that have something to show."""
    found = []
    if run.front:
        found.append(_trade_offs(run))
    elif run.entries:
        found.append(_block("design", "Design", "Selected design", "", CARD + ANNOUNCEMENT))
    if run.entries:
        found += [_parts_and_flight(), _designs(run)]
    if models is not None:
        found.append(_what_if(run, models))
    if validation is not None:
        found.append(_validation(run, validation))
    if len(run.front) > 1:
        found.append(_search(run))
    if reasons(run):
        found.append(_rejected(run))
    return [*found, _provenance(run)]


def _block(key: str, short: str, title: str, text: str, body: str, controls: str = "") -> Block:
    about = f"<p>{text}</p>" if text else ""
    head = f'<header><h2 id="{key}-title">{title}</h2>{controls}{about}</header>'
    html = f'<section class="block" id="{key}" aria-labelledby="{key}-title">{head}{body}</section>'
    return Block(key, short, html)


def _trade_offs(run: ReportData) -> Block:
    options = "".join(f'<option value="{k}">{escape(o.label)}</option>' for k, o in enumerate(run.objectives))
    controls = ""
    if len(run.objectives) > 1:
        controls = (
            f'<div class="controls"><label>Across <select id="axis-x">{options}</select></label>'
            f'<label>Up <select id="axis-y">{options}</select></label></div>'
        )
    shapes = {name: shape for name, shape in KEY.items() if name != "original" or run.baseline_vector is not None}
    shapes |= {escape(name): shape for name, shape in key_of_runs(run).items()}
    key = "".join(
        f'<li><svg width="14" height="14" aria-hidden="true">{shape}</svg>{name}</li>' for name, shape in shapes.items()
    )
    label = "All designs in two objectives. The table of all designs holds the same and can be used with the keyboard."
    body = (
        f'<div class="trade"><div class="chart"><div id="front" role="img" aria-label="{label}"></div>'
        f'<ul class="key">{key}</ul><p class="count"><span id="front-outside"></span> <span id="front-thinned"></span> '
        '<button type="button" class="link" data-save="front">Save as PNG</button></p>'
        f"{_weights(run)}{comparison_table(run)}</div>"
        f"{CARD}</div>{ANNOUNCEMENT}"
    )
    third = " Color is the remaining objective." if len(run.objectives) > 2 else ""
    text = f"{better_side(run)}.{third} Click a design to see it; drag to zoom, double-click to zoom back."
    return _block("trade-offs", "Trade-offs", "Trade-offs", text, body, controls)


def _weights(run: ReportData) -> str:
    """Sliders that weigh the objectives, if there is something to choose."""
    if len(run.objectives) < 2 or len(run.choices) < 2:
        return ""
    return (
        '<h3>What counts for you</h3><p class="count">Each objective counts from its best to its worst value among '
        "the best compromises that may be built; preferred is the design whose largest weighted loss is least.</p>"
        '<div id="weights" class="sliders"></div><p id="weights-choice" aria-live="polite"></p>'
    )


def _parts_and_flight() -> Block:
    body = (
        '<div id="parts" class="parts"></div><div id="parts-absent"></div>'
        '<h2 class="second">Flight of <span id="flight-name"></span></h2>'
        '<dl class="facts" id="flight-facts"></dl><div id="histories" class="histories"></div>'
    )
    title = 'Parts of <span id="parts-name"></span>'
    text = (
        "Colors end at the peak stress, from which the safety factor is made; stress right beside clamps, which no "
        "mesh settles, may be higher. Of a part with a plane of symmetry one half was analyzed. Drag to turn."
    )
    return _block("parts-and-flight", "Parts and flight", title, text, body)


def _designs(run: ReportData) -> Block:
    titles = {"front": "Best compromises", "feasible": "Feasible", "rejected": "Not feasible", "all": "All"}
    segments = "".join(
        f'<button type="button" data-filter="{key}" aria-pressed="false">{title}</button>'
        for key, title in titles.items()
    )
    controls = f'<div class="controls"><div class="segments" role="group" aria-label="Show">{segments}</div></div>'
    body = (
        '<div class="scroll" id="designs-scroll" tabindex="-1"><table aria-label="Designs">'
        '<thead id="designs-head"></thead><tbody id="designs-body"></tbody></table></div>'
        '<p class="count"><span id="designs-count" aria-live="polite"></span><span id="designs-sideways" hidden>; '
        "scroll sideways for more columns</span>. "
        '<button type="button" class="link" data-save="table">Save all as CSV</button></p>'
    )
    against = " Percentages compare with the original." if run.baseline_vector is not None else ""
    text = f"Sort by a column’s head; select with a click or with the arrow keys.{against}"
    return _block("designs", "All designs", "All designs", text, body, controls)


def _what_if(run: ReportData, models: WhatIf) -> Block:
    chart = ""
    if len(run.objectives) > 1:
        label = "The prediction with its 90 % bands beside the best compromises"
        chart = f'<div id="what-if-chart" role="img" aria-label="{label}"></div>'
    body = (
        '<div class="what-if"><div><div id="what-if-sliders" class="sliders"></div>'
        '<p class="count"><button type="button" class="link" id="what-if-selected">Start from the selected design'
        f'</button></p><div id="what-if-notes" aria-live="polite"></div>{chart}</div>'
        '<div id="what-if-numbers"></div></div>'
    )
    return _block("what-if", "What if", "What if", section_text(run, models), body)


def _validation(run: ReportData, validation: Validation) -> Block:
    size = validation.disturbance
    text = (
        "Chosen designs on trajectories that the search has not seen, each against the original on the same flight; in "
        f"disturbed flights with gusts of {size.gust:g} N and errors of {100 * size.mass:g} % in the mass of each body "
        f"and {100 * size.thrust:g} % in each thrust (standard deviations, the same seeds for all designs)."
    )
    chart = '<div id="validation-chart" role="img" aria-label="Change of each objective, flight by flight"></div>'
    body = chart + validation_tables(run, validation)
    return _block("validation", "Validation", "Validation", text, body)


def _search(run: ReportData) -> Block:
    grown, late = run.late_growth
    text = (
        "Volume of objective space that the designs found so far dominate, as a share of what this run had found at "
        "its end: 100 % is its own end, not the best there is. In the box that the front spans, the last quarter of "
        f"the designs added {100 * grown:.1f} % of the volume and {late} of the {len(run.front)} best compromises."
    )
    body = '<div id="progress" role="img" aria-label="Volume found by designs evaluated, of this run\'s end"></div>'
    return _block("search", "Search", "How the search went", text, body)


def _rejected(run: ReportData) -> Block:
    positions = {entry.id: i for i, entry in enumerate(run.entries)}
    rows = []
    for status, reason, ids in reasons(run):
        links = [
            f'<button type="button" class="link" data-select="{positions[i]}">{i}</button>' for i in ids[:SHOWN_IDS]
        ]
        more = f" and {len(ids) - SHOWN_IDS} more" if len(ids) > SHOWN_IDS else ""
        cells = f'<td>{status}</td><td>{escape(reason)}</td><td class="number">{len(ids)}</td>'
        rows.append(f"<tr>{cells}<td>{', '.join(links)}{more}</td></tr>")
    heads = "".join(f'<th scope="col">{head}</th>' for head in ("Outcome", "Reason", "Designs", "Which"))
    body = (
        f'<div class="sideways"><table class="plain"><thead><tr>{heads}</tr></thead><tbody>{"".join(rows)}</tbody>'
        "</table></div>"
    )
    text = (
        "Infeasible designs have numbers but break a constraint or lose the flight; skipped ones are nowhere better "
        "than a feasible design, so the rest was not computed; failed designs gave no numbers. None enters the ranking."
    )
    return _block("rejected", "Not feasible", "Designs that are not feasible", text, body)


def _provenance(run: ReportData) -> Block:
    def pairs(items: dict[str, str]) -> str:
        return "".join(f"<dt>{escape(key)}</dt><dd>{escape(value)}</dd>" for key, value in items.items() if value)

    meanings = {objective.title: objective.meaning for objective in run.objectives}
    facts = {spelled(key): value for key, value in run.provenance.items()}
    body = (
        f'<div class="columns"><div><h3>What is minimized</h3><dl class="pairs">{pairs(meanings)}</dl></div>'
        f'<div><h3>Where the numbers come from</h3><dl class="pairs">{pairs(facts)}</dl></div></div>'
    )
    return _block("provenance", "Provenance", "Definitions and provenance", "", body)
