"""Writes the page: one HTML text with style, font, script, plotly and data in it."""

from __future__ import annotations

import base64
import json
from html import escape
from importlib import resources
from string import Template
from typing import Any

import codesign
from codesign.report.data import ReportData
from codesign.report.page.document import page_document
from codesign.report.page.sections import sections
from codesign.report.page.summary import summary
from codesign.report.page.validation import strips
from codesign.report.page.what_if import what_if_document, what_if_models
from codesign.report.validation import Validation

SCRIPTS = ("base.js", "front.js", "weights.js", "table.js", "design.js", "search.js", "whatif.js", "main.js")


def render(
    run: ReportData,
    details: dict[str, Any] | None = None,
    files: dict[str, Any] | None = None,
    picture: bytes | None = None,
    validation: Validation | None = None,
) -> str:
    """The whole page as one HTML text that loads nothing from anywhere.

    details, files: by `details.detail_key`; fields and histories of designs, what can be downloaded of them.
    picture: PNG of the robot with the recommended design's parts.   validation: flights that the search has not seen.
    """
    from plotly.offline import get_plotlyjs

    folder = resources.files("codesign.report.page")
    read = {
        name: folder.joinpath(name).read_text(encoding="utf-8") for name in ("template.html", "style.css", *SCRIPTS)
    }
    models = what_if_models(run)
    blocks = sections(run, validation, models)
    document = page_document(run, details, files)
    document |= {"validation": strips(run, validation), "what_if": what_if_document(run, models)}
    return Template(read["template.html"]).substitute(
        version=escape(codesign.__version__),
        title=escape(run.title),
        font=base64.b64encode(folder.joinpath("inter.woff2").read_bytes()).decode(),
        style=read["style.css"],
        navigation="".join(f'<a href="#{block.key}">{block.short}</a>' for block in blocks),
        summary=summary(run, picture, validation),
        sections="\n".join(block.html for block in blocks),
        footer=f"<p>Made by codesign {escape(codesign.__version__)}. This file is complete: it needs no network.</p>",
        data=_json(document),
        plotly=get_plotlyjs(),
        script="\n".join(read[name] for name in SCRIPTS),
    )


def _json(document: dict[str, Any]) -> str:
    """JSON that cannot end its <script> element."""
    return json.dumps(document, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")
