"""Whether a design may be built: one verdict for the page, an export, the viewer and the terminal."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from codesign.problem.design_space import value_text
from codesign.problem.evaluation import Evaluation
from codesign.report.data import ReportData
from codesign.report.objections import UNSETTLED, Objection, objections
from codesign.report.reading import demands
from codesign.report.recommendation import passed_over, unsettled_search

TITLES = {"build": "Build {}", "candidate": "Candidate: {}", "barred": "{}"}
HEADS = {"build": "", "candidate": "Not to be built yet", "barred": "Not to be built"}
FINER = 'a finer mesh, [fem] accuracy = "fine" or a smaller edge_length_mm in study.toml'
OFTEN = 0.01  # share of the time at a limit from which on it is said
UNCHECKED = "Whether bodies collide was not checked: the study has no section [interference]."
ENDS = (("thrust_at_most", "largest", "max_thrust"), ("thrust_at_least", "smallest", "min_thrust"))


@dataclass(frozen=True, slots=True)
class Verdict:
    """What is said of building a design.

    kind: `build`: nothing speaks against it; `candidate`: not to be built before the reasons are settled; `barred`:
    another design is needed. name: of the design, "design 14". reasons, remedies, notes: sentences; notes hold for
    designs that may be built, too.
    """

    kind: Literal["build", "candidate", "barred"]
    name: str
    reasons: tuple[str, ...] = ()
    remedies: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()

    @property
    def title(self) -> str:
        """`Build design 14`, `Candidate: design 14`."""
        title = TITLES[self.kind].format(self.name)
        return title[:1].upper() + title[1:]

    @property
    def head(self) -> str:
        """What the reasons are of: `Not to be built yet`; "" where nothing speaks against the design."""
        return HEADS[self.kind]

    def document(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "may_be_built": self.kind == "build",
            "kind": self.kind,
            "title": self.title,
            "reasons": list(self.reasons),
            "remedies": list(self.remedies),
            "notes": list(self.notes),
        }


Judge = Callable[[Evaluation], Verdict]  # of a design whose evaluation is known later


def run_verdict(run: ReportData, position: int, evaluation: Evaluation | None = None) -> Verdict:
    """The verdict on an entry of a run. evaluation: of the same design, if it was evaluated again since."""
    entry, directory = run.entries[position], shlex.quote(str(run.directory))
    against = run.against(evaluation or entry.evaluation)
    further = (
        [text for text in (unsettled_search(run), passed_over(run)) if text] if position == run.recommended else []
    )
    notes = list(run.notes)
    tried = run.confirmed.get(tuple(entry.evaluation.design.values()))
    if tried is not None and not tried.parts:
        notes.append(f"Its parts could not be confirmed on a finer mesh: {tried.reason}.")
    notes += watch(evaluation or entry.evaluation)
    if run.recommended is None:
        notes.append("The report recommends no design of this run.")
    elif position != run.recommended:
        notes.append(f"The report recommends design {run.entries[run.recommended].id} instead.")
    named = "" if position == run.recommended else f" --designs {entry.id}"
    confirmed = run.as_confirmed(entry.evaluation) is not entry.evaluation
    remedies = _remedies(against, "" if confirmed else f"codesign confirm {directory}{named}")
    if run.notes and (remedies or further):
        remedies = ["The run cannot be continued, since its study or the program has changed: search again."]
    elif unsettled_search(run) in further:
        remedies.append(f"Search on: codesign resume {directory} --evaluations {2 * len(run.entries)}.")
    return _verdict(f"design {entry.id}", against, further, remedies, notes)


def study_verdict(study: Any, evaluation: Evaluation) -> Verdict:
    """The verdict on a design that is of no run."""
    config = study.configured(evaluation.design)
    against = objections(evaluation, demands(config), None, config.fem.tolerance)
    values = " ".join(f"--set {name}={value_text(value)}" for name, value in evaluation.design.items())
    command = f"codesign evaluate --study {study.source} {values} --confirm"
    notes = ["Its values were given, not found by a search: whether others are better is not known."]
    notes += watch(evaluation)
    return _verdict("this design", against, [], _remedies(against, command), notes)


def _verdict(
    name: str, against: Sequence[Objection], further: Sequence[str], remedies: Sequence[str], notes: Sequence[str]
) -> Verdict:
    reasons = [f"{o.text[:1].upper()}{o.text[1:]}." for o in against] + list(further)
    kind: Literal["build", "candidate", "barred"] = "candidate" if reasons else "build"
    if any(objection.final for objection in against):
        kind = "barred"
    return Verdict(kind, name, tuple(reasons), tuple(remedies), tuple(notes))


def _remedies(against: Sequence[Objection], command: str) -> list[str]:
    """What may lift the objections that are about the mesh. command: refines it; "" if that was done."""
    if not any(objection.kind in UNSETTLED for objection in against):
        return []
    if not command:
        return [f"Another run with {FINER}, may settle it."]
    return [f"{command} analyzes its parts in full on meshes refined at the peak; for a whole search: {FINER}."]


def watch(evaluation: Evaluation) -> list[str]:
    """Sentences on a design that flew; none on parts alone."""
    if not evaluation.flight:
        return []
    unchecked = [] if evaluation.flight.get("interference") else [UNCHECKED]
    return unchecked + _at_limits(evaluation.flight)


def _at_limits(flight: dict[str, Any]) -> list[str]:
    """The ends of the thrust that are met for more than a hundredth of the time, with share and extreme."""
    shares, found = flight.get("saturation", {}), []
    for key, end, extreme in ENDS:
        share = shares.get(key, 0.0)
        if share <= OFTEN:
            continue
        reached = flight.get(extreme)
        told = f" (it reached {reached:.3g}\u202fN)" if reached is not None else ""
        found.append(
            f"For {100 * share:.2g}\u202f% of the flight a thrust is within 1\u202f% of its range of the {end} that is "
            f"allowed{told}: there is no reserve for more."
        )
    return found
