"""Writes docs/paper.md: the paper's study and results beside ours.

  python benchmarks/published/paper.py --run runs/paper --published ../shared/data/published

Runs the study at the paper's size if there is no such run yet, validates chosen designs on the five other trajectories,
confirms them with full parts and fine meshes, flies the published robots as they are, re-evaluates the published best
compromises with consistent physics, and writes the page and its figures. `--published` is a folder with the
published robots (base_robot.urdf, optim1.urdf, optim3.urdf) and designs.csv, the table of their optimization run.
"""

from __future__ import annotations

import argparse
import csv
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from codesign import dynamics as dyn
from codesign.chain.documents import objective_families
from codesign.chain.flight import flight_settings, joint_names
from codesign.chain.study import Study, load_study
from codesign.followup.validation import validate
from codesign.problem.evaluation import Evaluation
from codesign.report.data import ReportData
from codesign.report.details import load_details
from codesign.report.figures import FigureData, style, write_figures
from codesign.report.reading import read_report_data
from codesign.report.validation import Validation, load_validation
from codesign.report.writing import compute_details
from codesign.search.optimization import optimize
from codesign.search.progress import ProgressBar
from codesign.storage.cache import MemoryCache
from codesign.storage.database import DATABASE
from codesign.storage.runs import Run, load_run

PAPER_SECONDS = 216.0  # a design, as the paper states
PAPER_YIELD, STATED_YIELD = 524.0, 462.0  # MPa: in the published safety factors, in the paper's text
ROBOTS = {"Original": "base_robot.urdf", "Optim1": "optim1.urdf", "Optim3": "optim3.urdf"}
PUBLISHED_THETA = {"Original": (15, 42, 80, 108), "Optim1": (1, 48, 88, 50), "Optim3": (1, 48, 100, 130)}
SHOWN = ("front", "chosen", "validation", "stress", "snapshots", "parts", "convergence")
ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Row:
    """A published design on our grid, its script objectives and its safety factors (yield as the paper states)."""

    theta: tuple[int, int, int, int]
    objectives: NDArray[np.float64]
    bracket: float
    forearm: float
    best: bool


def read_rows(table: Path) -> list[Row]:
    """Published designs whose flight was completed, each moved to the nearest point of our grid."""
    rows = []
    with table.open(newline="") as file:
        for line in csv.DictReader(file):
            if line["error"] == "1" or line["qp_status"] != "0" or float(line["angle_paper_deg"]) > 79:
                continue
            distance = max(40, 2 * round(float(line["distance_mm"]) / 2))
            angle, offset, length = (int(float(line[k])) for k in ("angle_paper_deg", "offset_mm", "length_mm"))
            objectives = [float(line[k]) for k in ("obj_momentum", "obj_velocity", "obj_thrust_N")]
            factors = [float(line[k]) * STATED_YIELD / PAPER_YIELD for k in ("sf_bracket", "sf_forearm")]
            rows.append(
                Row(
                    (angle, distance, offset, length),
                    np.array(objectives),
                    *factors,
                    best=line["pareto_feasible_sf10"] == "1",
                )
            )
    return rows


def the_run(folder: Path, study: Study, workers: int) -> Run:
    """The paper-size run in `folder`; made if there is none."""
    if not (folder / DATABASE).exists():
        with ProgressBar("study") as bar:
            optimize(study, out=folder, population=25, generations=40, seed=1, workers=workers, progress=bar)
    return load_run(folder)


def as_published(study: Study, urdf: Path, trajectory: str) -> dyn.FlightLog:
    """Flight of a published robot, inertias as they are in its file."""
    config = study.config
    model = dyn.load_urdf(urdf, joints=joint_names(config.flight), as_published=True)
    return dyn.simulate_flight(model, flight_settings(config.flight, config.trajectories[trajectory]))


def evaluate_rows(study: Study, rows: Sequence[Row], workers: int) -> dict[tuple[int, ...], Evaluation]:
    """Our evaluation of published designs, each once."""
    cache = MemoryCache()
    designs = sorted({row.theta for row in rows})
    with ThreadPoolExecutor(workers) as pool:  # the native chain releases the GIL
        return dict(zip(designs, pool.map(lambda theta: study.evaluate(theta, cache=cache), designs), strict=True))


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A Markdown table."""
    lines = ["| " + " | ".join(head) + " |", "|" + " --- |" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def change(new: float, old: float) -> str:
    """Relative change in words of a table."""
    return f"{new / old - 1:+.1%}"


def design_text(design: Mapping[str, float]) -> str:
    """Parameters in the order of the study."""
    return ", ".join(f"{value:g}" for value in design.values())


# --- sections ---------------------------------------------------------------------------------------------------------
def search_section(run: Run, data: ReportData) -> str:
    """What the search did and what it cost."""
    count = len(run.search_records)
    evaluated = [r for r in run.search_records if not r.cached]
    mean = float(np.mean([r.wall_seconds for r in evaluated])) if evaluated else 0.0
    counts = ", ".join(f"{number} {status}" for status, number in data.counts.most_common())
    rows = [
        ("designs evaluated", "1000 planned, 401 in the published table", f"{count} ({counts})"),
        (
            "time",
            f"{PAPER_SECONDS:.0f} s per design, 60 h",
            f"{mean:.2f} s per design and worker, {run.seconds / 60:.1f} min",
        ),
        ("programs", "CAD, FEM, simulation and optimization packages under license", "this one"),
    ]
    return table(("", "paper", "here"), rows)


def reproduction_section(study: Study, published: Path) -> str:
    """The published robots flown as published."""
    rows = []
    for name, file in ROBOTS.items():
        log = as_published(study, published / file, study.config.flight.trajectory)
        script = objective_families([log])["script"]
        numbers = [f"{script[k]:.6f}" for k in ("momentum", "joint_velocity")] + [f"{script['thrust']:.5f} N"]
        rows.append((name, *(numbers if log.completed else [f"lost at {log.failure_time:.2f} s", "", ""])))
    return table(("robot as published", "momentum", "joint velocity", "thrust"), rows)


def validation_published(study: Study, published: Path) -> str:
    """Change of the published optima from the published original on the validation trajectories, as published."""
    names = study.config.validation.trajectories
    families = {}
    for robot, file in ROBOTS.items():
        for name in names:
            log = as_published(study, published / file, name)
            families[robot, name] = objective_families([log])["script"] if log.completed else None
    rows = []
    for robot in ("Optim1", "Optim3"):
        for key, label in (("momentum", "momentum"), ("joint_velocity", "joint velocity"), ("thrust", "thrust")):
            pairs = [(families[robot, n], families["Original", n]) for n in names]
            cells = [change(a[key], b[key]) if a and b else "lost" for a, b in pairs]
            known = [a[key] / b[key] - 1 for a, b in pairs if a and b]
            rows.append((robot, label, *cells, f"**{np.mean(known):+.1%}**" if known else "–"))
    labels = [name.replace("trajectory_", "T") for name in names]
    return table(("robot as published", "script objective", *labels, "mean"), rows)


def validation_ours(flown: Validation, data: ReportData) -> str:
    """Change of our designs from the original on the validation trajectories."""
    rows = []
    for role in (role for role in flown.roles if role != "original"):
        for objective in data.objectives:
            calm = flown.change(role, objective.key, disturbed=False)
            wild = flown.change(role, objective.key, disturbed=True)
            cells = [f"{calm[n, None]:+.1%}" if (n, None) in calm else "lost" for n in flown.trajectories]
            means = [f"**{np.mean(list(values.values())):+.1%}**" if values else "–" for values in (calm, wild)]
            rows.append((role, objective.label.lower(), *cells, *means))
    labels = [name.replace("trajectory_", "T") for name in flown.trajectories]
    lost = [f for f in flown.flights if not f.completed]
    calm_lost = sum(f.seed is None for f in lost)
    by_role = ", ".join(f"{role} {sum(f.role == role for f in lost)}" for role in flown.roles)
    note = (
        f"\n{len(lost)} of {len(flown.flights)} flights were lost, {calm_lost} of them calm ({by_role}); they are left "
        "out of the means.\n"
    )
    return table(("design", "rms objective", *labels, "mean", "mean, disturbed"), rows) + note


def designs_section(study: Study, data: ReportData, evaluations: Mapping[tuple[int, ...], Evaluation]) -> str:
    """Parameters, objectives and safety factors of chosen designs, consistent physics."""
    chosen: dict[str, Evaluation] = {
        f"{name} of the paper": evaluations[theta] for name, theta in PUBLISHED_THETA.items()
    }
    chosen |= {role: e for role, e in data.highlights.items() if role != "original"}
    rows = []
    for role, e in chosen.items():
        fine = study.confirm(e.design)
        factors = [
            f"{e.parts[name]['safety_factor']:.1f} ({fine[name].confirmed['safety_factor']:.1f})"
            for name in study_parts(study)
        ]
        numbers = [f"{e.objectives[k]:.4g}" if e.objectives else "–" for k in data.keys]
        masses = 2 * sum(e.parts[name]["mass"] for name in study_parts(study))
        rows.append((role, design_text(e.design), *numbers, *factors, f"{masses:.2f} kg"))
    head = ("design", "angle, distance, offset, length", *(o.title for o in data.objectives))
    return table((*head, *(f"SF {name.replace('_', ' ')}" for name in study_parts(study)), "four interfaces"), rows)


def study_parts(study: Study) -> list[str]:
    """Names of the parts."""
    return [part.name for part in study.config.parts]


def front_section(data: ReportData, rows: Sequence[Row], evaluations: Mapping[tuple[int, ...], Evaluation]) -> str:
    """The published best compromises in our physics against our front."""
    best = {row.theta for row in rows if row.best}
    flown = [evaluations[theta] for theta in best if evaluations[theta].status == "feasible"]
    values = np.array([data.vector(e) for e in flown])
    front = data.values[data.front]
    dominated = sum(bool(((front <= v).all(axis=1) & (front < v).any(axis=1)).any()) for v in values)
    ours = sum(bool(((values <= v).all(axis=1) & (values < v).any(axis=1)).any()) for v in front)
    original = data.baseline_vector
    if original is None:
        raise SystemExit("the original design has no objectives: its flight was lost")
    gains = [
        (o.label, f"{original[k]:.5g}", f"{front[:, k].min():.5g}", change(front[:, k].min(), original[k]))
        for k, o in enumerate(data.objectives)
    ]
    return (
        f"{len(front)} best compromises; {len(data.dominating)} of them are better than the original in everything.\n\n"
        + table(("objective (rms)", "original", "lowest on the front", "change"), gains)
        + f"\nThe {len(best)} best compromises of the published table, moved to the study's grid and evaluated here: "
        f"{len(flown)} feasible, {dominated} of them dominated by the run's front; {ours} of its {len(front)} are "
        "dominated by one of theirs.\n"
    )


def script_correlation(rows: Sequence[Row], evaluations: Mapping[tuple[int, ...], Evaluation]) -> str:
    """Rank correlation of published and our script objectives over the published best compromises."""
    from scipy.stats import spearmanr

    pairs = [
        (row.objectives, [evaluations[row.theta].objective_families["script"][k] for k in KEYS])
        for row in rows
        if row.best and evaluations[row.theta].objective_families
    ]
    theirs, ours = (np.array([pair[i] for pair in pairs]) for i in (0, 1))
    lines = [
        (
            label,
            f"{np.median(ours[:, k] / theirs[:, k]):.3f}",
            f"{np.abs(ours[:, k] / theirs[:, k] - 1).max():.1%}",
            f"{spearmanr(theirs[:, k], ours[:, k]).statistic:+.2f}",
        )
        for k, label in enumerate(("momentum", "joint velocity", "thrust"))
    ]
    head = ("script objective", "median ratio, codesign / published", "largest difference", "rank correlation")
    return table(head, lines)


KEYS = ("momentum", "joint_velocity", "thrust")


def strength_section(rows: Sequence[Row], evaluations: Mapping[tuple[int, ...], Evaluation]) -> str:
    """Published safety factors beside ours."""
    lines = []
    for name, key in (("jetpack_bracket", "bracket"), ("forearm_support", "forearm")):
        used = [row for row in rows if row.theta in evaluations and name in evaluations[row.theta].parts]
        unique = {row.theta[:2] if key == "bracket" else row.theta[2:]: row for row in used}
        ours = np.array([evaluations[row.theta].parts[name]["safety_factor"] for row in unique.values()])
        theirs = np.array([getattr(row, key) for row in unique.values()])
        ratio = ours / theirs
        lines.append(
            (name.replace("_", " "), str(len(ratio)), f"{theirs.min():.1f} … {theirs.max():.1f}",
             f"{ours.min():.1f} … {ours.max():.1f}", f"{np.median(ratio):.2f}",
             f"{ratio.min():.2f} … {ratio.max():.2f}")
        )  # fmt: skip
    head = ("part", "designs", "published × 462/524", "here", "median ratio", "range of the ratio")
    return table(head, lines)


# --- figures ----------------------------------------------------------------------------------------------------------
def draw_fronts(path: Path, data: ReportData, rows: Sequence[Row], flown: Mapping[tuple[int, ...], Evaluation]) -> None:
    """Published table and our run side by side, in the paper's two axes, thrust as color."""
    from matplotlib.figure import Figure

    with style.style():
        figure = Figure(figsize=(style.PAGE, 3.1))
        left, right = figure.subplots(1, 2)
        theirs = np.array([row.objectives for row in rows])
        best = np.array([row.best for row in rows])
        left.scatter(theirs[~best, 0], theirs[~best, 1], 6, style.DOT, linewidths=0, label="flown")
        dots = left.scatter(*theirs[best, :2].T, 20, theirs[best, 2], cmap=style.THIRD, edgecolors="white",
                            linewidths=0.4, label="best compromise")  # fmt: skip
        left.set(title="published table (script objectives)", xlabel="momentum", ylabel="joint velocity")
        left.set(xlim=(109, 135), ylim=(670, 780))
        figure.colorbar(dots, ax=left, aspect=32, pad=0.02, label="thrust (N)")
        own = data.values
        feasible = data.feasible & np.isfinite(own).all(axis=1)
        right.scatter(*own[feasible, :2].T, 6, style.DOT, linewidths=0, label="feasible")
        dots = right.scatter(*own[data.front, :2].T, 20, own[data.front, 2], cmap=style.THIRD, edgecolors="white",
                             linewidths=0.4, label="best compromise")  # fmt: skip
        there = np.array([data.vector(flown[t]) for t in {r.theta for r in rows if r.best} if flown[t].objectives])
        right.scatter(
            *there[:, :2].T, 12, "none", "o", edgecolors=style.INK, linewidths=0.5, label="theirs, flown here"
        )
        if data.baseline_vector is not None:
            right.scatter(
                *data.baseline_vector[:2], 34, style.ORIGINAL, marker="D", edgecolors="white", label="original"
            )
        right.set(title="here (rms objectives)", xlabel=data.objectives[0].title, ylabel=data.objectives[1].title)
        seen = np.vstack([own[data.front], there, data.vector(data.baseline)])[:, :2]
        low, high = seen.min(axis=0), seen.max(axis=0)
        margin = 0.06 * (high - low)
        right.set(xlim=(low[0] - margin[0], high[0] + margin[0]), ylim=(low[1] - margin[1], high[1] + margin[1]))
        figure.colorbar(dots, ax=right, aspect=32, pad=0.02, label="thrust (N)")
        for axes in (left, right):
            axes.legend(loc="upper right", frameon=True, edgecolor="none", framealpha=0.85)
        figure.savefig(path, metadata={"Software": None})


def draw_strength(path: Path, rows: Sequence[Row], flown: Mapping[tuple[int, ...], Evaluation]) -> None:
    """Safety factors: published against ours."""
    from matplotlib.figure import Figure

    with style.style():
        figure = Figure(figsize=(style.PAGE, 2.8))
        for axes, name, key in zip(
            figure.subplots(1, 2), ("jetpack_bracket", "forearm_support"), ("bracket", "forearm"), strict=True
        ):
            used = [row for row in rows if row.theta in flown and name in flown[row.theta].parts]
            ours = [flown[row.theta].parts[name]["safety_factor"] for row in used]
            theirs = [getattr(row, key) for row in used]
            axes.scatter(theirs, ours, 10, style.BLUE, linewidths=0, alpha=0.7)
            low, high = min(theirs + ours), max(theirs + ours)
            axes.plot([low, high], [low, high], color=style.MUTED, linewidth=0.8, label="equal")
            axes.set(xlabel="published, × 462/524", ylabel="here", title=f"safety factor, {name.replace('_', ' ')}")
            axes.legend(loc="upper left")
        figure.savefig(path, metadata={"Software": None})


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--run", type=Path, default=Path("runs/paper"))
    parser.add_argument("--published", type=Path, default=ROOT.parent / "shared" / "data" / "published")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--page", type=Path, default=ROOT / "docs" / "paper.md")
    given = parser.parse_args()
    study = load_study("ironcub_paper")
    run = the_run(given.run, study, given.workers)
    if load_validation(given.run) is None:
        validate(given.run, workers=given.workers)
    data = read_report_data(given.run, study)
    data = compute_details(study, data)
    flown = load_validation(given.run)
    rows = read_rows(given.published / "designs.csv")
    wanted = [row for row in rows if row.best]
    wanted += [Row(theta, np.zeros(3), 0.0, 0.0, best=False) for theta in PUBLISHED_THETA.values()]
    evaluations = evaluate_rows(study, wanted, given.workers)
    figures = given.page.parent / "figures" / "paper"
    written = write_figures(FigureData(data, load_details(given.run), study, flown), figures, SHOWN)
    for path in written:
        if path.suffix == ".pdf":
            path.unlink()
    draw_fronts(figures / "fronts.png", data, rows, evaluations)
    draw_strength(figures / "strength.png", [row for row in rows if row.best], evaluations)
    template = (Path(__file__).parent / "paper.md.template").read_text(encoding="utf-8")
    page = template.format(
        search=search_section(run, data),
        reproduction=reproduction_section(study, given.published),
        designs=designs_section(study, data, evaluations),
        front=front_section(data, rows, evaluations),
        validation_published=validation_published(study, given.published),
        validation=validation_ours(flown, data) if flown is not None else "",
        correlation=script_correlation(rows, evaluations),
        strength=strength_section([row for row in rows if row.best], evaluations),
        rows=len(rows),
    )
    given.page.write_text(page, encoding="utf-8")
    print(given.page)


if __name__ == "__main__":
    main()
