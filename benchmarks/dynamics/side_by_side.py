"""Runs of the study as published and of the default one side by side: time, front, what changed in the recommendation.

  codesign optimize --study ironcub_paper --population 25 --generations 40 --seed 1 --workers 1 --out PAPER
  codesign optimize --algorithm surrogate --evaluations 200 --seed 1 --workers 1 --original --out DEFAULT
  python benchmarks/dynamics/side_by_side.py PAPER DEFAULT

Prints Markdown: both searches; each run's recommended design flown and analyzed by both studies; how many designs of
the published front keep the default's clearances in their own calm flight; and designs of the default's front, far
apart, under the published study: how many its front beats. With `--again N`, N designs of the first run are evaluated
anew, and must give the stored objectives bit for bit.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from codesign import Study, load_study
from codesign.problem.design_space import DesignValue
from codesign.problem.evaluation import Evaluation
from codesign.report.data import ReportData
from codesign.report.pareto import dominates
from codesign.report.reading import read_report_data
from codesign.storage.cache import MemoryCache
from codesign.storage.runs import Run, load_run
from codesign.units import MILLIMETER

MOMENTUM, VELOCITY, THRUST = "momentum", "joint_velocity", "thrust"
Theta = dict[str, DesignValue]


@dataclass(frozen=True)
class Searched:
    """A study, a run of it, and what its report recommends."""

    study: Study
    run: Run
    data: ReportData

    @classmethod
    def read(cls, folder: Path, name: str) -> Searched:
        """A run in a folder, of a shipped study."""
        study = load_study(name)
        return cls(study, load_run(folder), read_report_data(folder, study))

    @property
    def recommended(self) -> Theta:
        """The design that the report recommends."""
        if self.data.recommended is None:
            raise SystemExit(f"{self.run.out}: no design is recommended")
        return dict(self.data.entries[self.data.recommended].evaluation.design)

    @property
    def front(self) -> list[Evaluation]:
        """The best compromises."""
        return [self.data.entries[i].evaluation for i in self.data.front]


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = ["| " + " | ".join(head) + " |", "|" + " --- |" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def searches(paper: Searched, default: Searched) -> str:
    """What each search did, took and found."""
    rows: dict[str, list[str]] = {}
    for side in (paper, default):
        counts, values = side.data.counts, side.data.values[side.data.front]
        original = side.data.vector(side.data.baseline or side.study.evaluate(dict(side.study.config.baseline or {})))
        wall = [r.wall_seconds for r in side.run.search_records if not r.cached]
        cells = {
            "search": f"{side.run.settings['algorithm']}, {len(side.run.records)} designs",
            "wall time": f"{side.run.seconds / 60:.0f} min",
            "… of an evaluation, median": f"{np.median(wall):.2f} s",
            "feasible, infeasible, failed": ", ".join(str(counts[s]) for s in ("feasible", "infeasible", "failed")),
            "best compromises": f"{len(side.data.front)}",
            "… better than the Original in everything": f"{sum(dominates(value, original) for value in values)}",
        }
        for variable in paper.data.variables:
            found = [float(e.design[variable.name]) for e in side.front]
            cells[f"… {paper.data.label(variable)}, {variable.unit}"] = f"{min(found):g} to {max(found):g}"
        for k, objective in enumerate(side.data.objectives):
            cells[f"… {objective.title}"] = f"{values[:, k].min():.5g} to {values[:, k].max():.5g}"
        for name, cell in cells.items():
            rows.setdefault(name, []).append(cell)
    return table(("", paper.study.name, default.study.name), [(name, *cells) for name, cells in rows.items()])


def common(theta: Mapping[str, DesignValue], study: Study) -> Theta:
    """The same design in another study: what one varies and the other does not is as in its Original, or left out."""
    known = dict(study.config.baseline or {}) | dict(theta)
    return {v.name: known[v.name] for v in study.space.variables}


def decides(evaluation: Evaluation, part: str) -> str:
    document = evaluation.parts[part]
    factors = [f"{case['safety_factor']:.1f} {name}" for name, case in document["cases"].items()]
    return factors[0].split()[0] if len(factors) == 1 else ", ".join(factors[:3])


def both_ways(paper: Searched, default: Searched) -> str:
    """The Original and each run's recommended design, evaluated by both studies."""
    designs = {
        "Original": dict(paper.study.config.baseline or {}),
        "recommended by the published study": paper.recommended,
        "recommended by the default": default.recommended,
    }
    head = ("design", "study", "momentum", "joint velocity", "thrust N", "body, plume mm", "bracket", "support", "")
    return table(head, list(_both_ways(designs, (paper.study, default.study))))


def _both_ways(designs: Mapping[str, Theta], studies: Sequence[Study]) -> Iterator[tuple[str, ...]]:
    for name, theta in designs.items():
        for study in studies:
            result = study.evaluate(common(theta, study))
            values = result.objectives or {}
            clearances = (result.constraints[f"{kind}_clearance"] / MILLIMETER for kind in ("body", "plume"))
            yield (
                f"{name}: {', '.join(str(v) for v in common(theta, studies[0]).values())}",
                study.name,
                *(f"{values[key]:.4g}" if values else "–" for key in (MOMENTUM, VELOCITY)),
                f"{values[THRUST]:.1f}" if values else "–",
                ", ".join(f"{x:.0f}" for x in clearances),
                *(decides(result, part.name) if part.name in result.parts else "–" for part in study.config.parts),
                "" if result.status == "feasible" else f"{result.status}: {result.reason}",
            )


def clear(paper: Searched, default: Searched) -> str:
    """How much of the published front would keep the default's clearances, were it calm."""
    limits = default.study.config.constraints
    ignored = default.study.config.interference
    own = {frozenset(pair) for pair in ignored.ignore} if ignored else set()
    kept = []
    for e in paper.front:
        pairs = e.flight["interference"]
        body = min((p["clearance"] for p in pairs["bodies"] if frozenset(p["links"]) not in own), default=np.inf)
        kept.append((body, e.constraints["plume_clearance"]))
    body, plume = np.array(kept).T / MILLIMETER
    ok = (body >= limits.body_clearance_min_mm) & (plume >= limits.plume_clearance_min_mm)
    return f"{ok.sum()} of {len(ok)} designs of the published front keep both clearances in their own calm flight.\n"


def beaten(paper: Searched, default: Searched, count: int) -> str:
    """Designs of the default's front under the published study, against its front."""
    values = default.data.values[default.data.front]
    values = (values - values.min(axis=0)) / np.ptp(values, axis=0)
    order = [int(np.argmin(np.linalg.norm(values - 0.5, axis=1)))]
    while len(order) < min(count, len(values)):
        order.append(int(np.argmax(np.linalg.norm(values[:, None] - values[order], axis=2).min(axis=1))))
    cache = MemoryCache()
    front = [np.array([(e.objectives or {})[key] for key in paper.data.keys]) for e in paper.front]
    lost, losses = 0, []
    for i in order:
        result = paper.study.evaluate(common(default.front[i].design, paper.study), cache=cache)
        value = np.array([(result.objectives or {})[key] for key in paper.data.keys])
        over = [other for other in front if dominates(other, value)]
        lost += bool(over)
        losses.append(min((float((value / other - 1.0).max()) for other in front), default=0.0))
    return (
        f"Under the published study {lost} of {len(order)} designs of the default's front are beaten by the published "
        f"front; the median one lies within {np.median(losses):.1%} of its nearest member in every objective.\n"
    )


def again(paper: Searched, count: int) -> str:
    """Stored rows of the published study, evaluated anew."""
    rows = [r.evaluation for r in paper.run.records if r.evaluation.objectives]
    chosen = [rows[i] for i in np.linspace(0, len(rows) - 1, count).astype(int)]
    cache = MemoryCache()
    same = sum(paper.study.evaluate(dict(e.design), cache=cache).objectives == e.objectives for e in chosen)
    return f"{same} of {len(chosen)} stored rows of the published study come out again bit for bit.\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("paper", type=Path)
    parser.add_argument("default", type=Path)
    parser.add_argument("--designs", type=int, default=29, help="of the default's front under the published study")
    parser.add_argument("--again", type=int, default=0)
    asked = parser.parse_args()
    paper, default = Searched.read(asked.paper, "ironcub_paper"), Searched.read(asked.default, "ironcub")
    print(searches(paper, default), flush=True)
    print(both_ways(paper, default), flush=True)
    print(clear(paper, default), flush=True)
    print(beaten(paper, default, asked.designs), flush=True)
    if asked.again:
        print(again(paper, asked.again))


if __name__ == "__main__":
    main()
