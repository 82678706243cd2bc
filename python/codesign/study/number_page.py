"""The page of all numbers that objectives and limits may name."""

from __future__ import annotations

from codesign.problem.numbers import ALWAYS_ZERO, ASKED, MISSING, NUMBERS, Number, known_number
from codesign.problem.quantities import FAMILY, QUANTITIES, Quantity

BAR = r"\|"  # in a cell of a table
NEEDS = (
    MISSING
    | {need: f"else 0: {why}" for need, why in ALWAYS_ZERO.items()}
    | {ASKED: "an objective or a limit that names it"}
)
HEAD = """\
# Numbers for objectives and limits

What `minimize` and `maximize` of `[objectives]` and the keys of `[constraints.limits]` may name: a short name, or the
path of any number of the document that `codesign evaluate --json` prints. Limits are in the SI units given here,
whatever tables show.

```toml
[objectives]
minimize = ["mass", "sum(parts.*.work)"]
maximize = ["first_frequency"]
[constraints.limits]
"max_displacement" = { max = 2e-4 } # m
"parts.arm.cases.landing.safety_factor" = { min = 2.0 }
"costs:price" = { max = 80.0 } # def price(document) in costs.py beside study.toml
```

A word in capitals stands for a name of the study (PART, CASE, JOINT) or an index from 0 (N). `*` in its place means all
of them and needs `min(…)`, `max(…)` or `sum(…)` around the path. "needs" is what the study must have. `codesign check
STUDY` refuses names that are not here, and notes objectives and limits on numbers that are 0 for every design.

This page is written by `python scripts/study_reference.py` from `codesign.problem.numbers`; tests compare it with
evaluations.

## Short names

| name | unit | meaning | path | needs |
| --- | --- | --- | --- | --- |
"""
SECTIONS = (
    ("Of a part", "parts.PART.", "parts.PART.cases."),
    ("Of a load case of a part", "parts.PART.cases.CASE.", "-"),
    ("Of the flight", "flight.", "-"),
    ("Objective families", "objective_families.", "-"),
)


def numbers_page() -> str:
    """Markdown: short names and paths with unit, meaning and what they need."""
    lines = [HEAD.rstrip("\n"), *(_short_row(known) for known in QUANTITIES.values())]
    for title, prefix, without in SECTIONS:
        lines += ["", f"## {title}", "", "| path | unit | meaning | needs |", "| --- | --- | --- | --- |"]
        chosen = (n for n in NUMBERS if n.path.startswith(prefix) and not n.path.startswith(without))
        lines += [f"| `{n.path}` | {n.unit} | {n.meaning.replace('|', BAR)} | {_needs(n)} |" for n in chosen]
    return "\n".join(lines) + "\n"


def _short_row(known: Quantity) -> str:
    number = known_number(known.key)
    assert number is not None  # a test asks for every one
    path = f"`{known.path}`" if known.path else "by `objectives.family`" if known.key in FAMILY else f"`{number.path}`"
    meaning = known.meaning or known.label
    cells = (f"`{known.key}`", number.unit or known.unit, meaning, path, _needs(number))
    return f"| {' | '.join(cell.replace('|', BAR) for cell in cells)} |"


def _needs(number: Number) -> str:
    return NEEDS.get(number.needs, "")
