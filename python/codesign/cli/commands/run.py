"""Commands about runs: optimize, resume, runs, report, validate, confirm, reevaluate, tolerances; tables of parts."""

from __future__ import annotations

import json
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from codesign.cli.console import err, out, print_json, print_run, print_runs
from codesign.cli.options import (
    DEFAULT_STUDY,
    INTERRUPTED,
    STUDY_HELP,
    ClusterOption,
    JsonOption,
    NoCacheOption,
    RunArgument,
    StudyOption,
    WorkersOption,
    complete_study,
)
from codesign.errors import StoreError, StudyError

if TYPE_CHECKING:
    from codesign.chain.study import Study
    from codesign.problem.design_space import Design
    from codesign.search.optimization import Resources

commands = typer.Typer()
OriginalOption = Annotated[
    bool, typer.Option("--original", help="The study's original design is the first of the start population.")
]


@commands.command(
    epilog="Example: `codesign optimize --population 25 --generations 40 --seed 1 --workers 2 --out runs/a`"
)
def optimize(
    study: StudyOption = DEFAULT_STUDY,
    population: Annotated[int | None, typer.Option(min=2, help="Designs per generation.")] = None,
    generations: Annotated[int | None, typer.Option(min=1, help="Generations, the start population included.")] = None,
    evaluations: Annotated[
        int | None, typer.Option(min=1, help="The budget itself, instead of generations; surrogate: 200.")
    ] = None,
    seed: Annotated[int | None, typer.Option(min=0, help="Decides all that is random; default: the study's.")] = None,
    workers: WorkersOption = None,
    cluster: ClusterOption = None,
    out_dir: Annotated[Path | None, typer.Option("--out", help="New folder of the run.")] = None,
    algorithm: Annotated[
        str | None,
        typer.Option(help="surrogate, nsga2, nsga3, agemoea, agemoea2, smsemoa or random; default: the study's."),
    ] = None,
    start: Annotated[str, typer.Option(help="sobol, sobol-plain (as in the paper) or random.")] = "sobol",
    original: OriginalOption = False,
    steady: Annotated[bool, typer.Option(help="Offspring without waiting for whole generations.")] = False,
    wall_time: Annotated[float | None, typer.Option(help="Seconds after which no new design is tried.")] = None,
    stall_generations: Annotated[
        int | None, typer.Option(min=1, help="Stop after so many generations without gain of hypervolume.")
    ] = None,
    no_cache: NoCacheOption = False,
    as_json: JsonOption = False,
) -> int:
    """The study: searches the design grid for the best compromises."""
    from codesign.chain.study import load_study
    from codesign.search.optimization import optimize as run_optimize
    from codesign.search.progress import ProgressBar

    loaded = load_study(study)
    folder = out_dir or Path("runs") / f"{loaded.name}-{datetime.now(UTC):%Y%m%d-%H%M%S}"
    resources: Resources = {"workers": workers, "cluster": cluster}
    if no_cache:
        resources["cache"] = None
    try:
        with ProgressBar(loaded.name) as bar:
            resources["progress"] = bar
            run = run_optimize(
                loaded,
                out=folder,
                population=population,
                generations=generations,
                evaluations=evaluations,
                seed=seed,
                algorithm=algorithm,
                start=start,
                first=_original(loaded) if original else [],
                steady=steady,
                wall_time=wall_time,
                stall_generations=stall_generations,
                **resources,
            )
    except ValueError as error:
        raise StudyError(str(error)) from error
    except KeyboardInterrupt:
        err.print(f"continue with: codesign resume {folder}")
        return INTERRUPTED
    return print_run(run, as_json)


def _original(study: Study) -> list[Design]:
    if study.baseline is None:
        raise StudyError(f"{study.path}: --original: the study names no original design, [baseline]")
    return [study.baseline]


@commands.command(epilog="Example: `codesign resume runs/a`")
def resume(
    run_dir: RunArgument,
    workers: WorkersOption = None,
    cluster: ClusterOption = None,
    evaluations: Annotated[int | None, typer.Option(min=1, help="A larger budget than the run had.")] = None,
    wall_time: Annotated[
        float | None, typer.Option(help="Seconds from now after which no new design is tried.")
    ] = None,
    as_json: JsonOption = False,
) -> int:
    """Continues an interrupted run, as if it had never stopped."""
    from codesign.search.optimization import resume as run_resume
    from codesign.search.progress import ProgressBar

    try:
        with ProgressBar(run_dir.name) as bar:
            run = run_resume(
                run_dir, workers=workers, cluster=cluster, evaluations=evaluations, wall_time=wall_time, progress=bar
            )
    except KeyboardInterrupt:
        err.print(f"continue with: codesign resume {run_dir}")
        return INTERRUPTED
    return print_run(run, as_json)


@commands.command(epilog="Example: `codesign tabulate --study ironcub_paper --workers 2 --out tables`")
def tabulate(
    study: StudyOption = DEFAULT_STUDY,
    parts: Annotated[list[str] | None, typer.Option("--part", help="A part of the study; default: all.")] = None,
    out_dir: Annotated[Path | None, typer.Option("--out", help="Folder of the tables; goes on with one begun.")] = None,
    most: Annotated[int, typer.Option(min=1, help="Designs of a part that are not too many.")] = 20_000,
    workers: WorkersOption = None,
    cluster: ClusterOption = None,
    as_json: JsonOption = False,
) -> int:
    """Parts over the whole grid of their variables, into the cache: the study then meshes and solves nothing."""
    from codesign.chain.study import load_study
    from codesign.cli.console import print_tables
    from codesign.followup.tables import tabulate as run_tabulate
    from codesign.search.progress import ProgressBar

    loaded = load_study(study)
    folder = out_dir or Path("tables") / loaded.name
    try:
        with ProgressBar(loaded.name) as bar:
            tables = run_tabulate(
                loaded, parts or (), out=folder, most=most, workers=workers, cluster=cluster, progress=bar
            )
    except KeyboardInterrupt:
        err.print("the same command goes on where it was stopped", soft_wrap=True)
        return INTERRUPTED
    return print_tables(tables, as_json)


@commands.command("runs", epilog="Example: `codesign runs runs --json`")
def runs_command(
    folder: Annotated[Path, typer.Argument(help="Folder that holds runs, at any depth.")] = Path("runs"),
    compare: Annotated[bool, typer.Option(help="Compare their fronts in one common box.")] = False,
    as_json: JsonOption = False,
) -> int:
    """Lists the runs in a folder, or compares their fronts."""
    from codesign.storage.runs import compare_runs, find_runs, list_runs, load_run

    found = list(find_runs(folder))
    if not found:
        raise StoreError(f"{folder}: holds no run" if folder.is_dir() else f"{folder}: there is no such folder")
    rows = compare_runs([load_run(run) for run in found]) if compare else list_runs(folder)
    if as_json:
        print_json(rows)
        return 0
    print_runs(rows, ("non_dominated",) if compare else ("seconds", "missing", "outcome"))
    for row in rows:
        if "error" in row:
            err.print(f"{row['run']}: {row['error']}", soft_wrap=True)
    return 0


@commands.command(epilog="Example: `codesign report runs/a`")
def report(
    run_dir: RunArgument,
    compare: Annotated[
        list[Path] | None, typer.Option(help="Another run with the same objectives: its front beside this one's.")
    ] = None,
    as_json: JsonOption = False,
) -> int:
    """One self-contained HTML page and the figures of a run."""
    from codesign.report import write_report

    paths = write_report(run_dir, compare=compare or [])
    if as_json:
        print_json({"page": str(paths.html), "figures": [str(path) for path in paths.figures]})
    else:
        out.print(f"report: {paths.html.resolve()}", soft_wrap=True)
    return 0


@commands.command(epilog="Example: `codesign validate runs/a --designs recommended --designs best`")
def validate(
    run_dir: RunArgument,
    designs: Annotated[list[str] | None, typer.Option(help="recommended, best, front, spread:N or a number.")] = None,
    trajectories: Annotated[list[str] | None, typer.Option(help="Of the study; default: its [validation].")] = None,
    seeds: Annotated[int, typer.Option(min=0, help="Disturbed repetitions of each flight.")] = 5,
    workers: WorkersOption = None,
) -> int:
    """Flies chosen designs and the original on validation trajectories; the report shows the result."""
    from codesign.followup.validation import DEFAULT_DESIGNS
    from codesign.followup.validation import validate as run_validate

    run_validate(run_dir, designs or DEFAULT_DESIGNS, trajectories or None, seeds=seeds, workers=workers)
    out.print(f"validated; show it with: codesign report {run_dir}", soft_wrap=True)
    return 0


@commands.command(epilog="Example: `codesign confirm runs/a`")
def confirm(
    run_dir: RunArgument,
    designs: Annotated[
        list[str] | None,
        typer.Option(help="recommended, best, front, spread:N or a number; default: what the recommendation needs."),
    ] = None,
    workers: WorkersOption = None,
    as_json: JsonOption = False,
) -> int:
    """Analyzes parts again, in full on meshes refined at the peak: the report then judges them by that.

    By default the recommended design, and the best compromises that only the error of their stress speaks against.
    """
    from codesign.cli.confirmations import print_confirmed
    from codesign.followup.confirmation import confirm_designs
    from codesign.report.reading import read_report_data, study_of
    from codesign.search.progress import ProgressBar

    try:
        with ProgressBar(run_dir.name) as bar:
            found = confirm_designs(run_dir, designs or [], workers=workers, progress=bar)
    except KeyboardInterrupt:
        err.print("the same command goes on where it was stopped", soft_wrap=True)
        return INTERRUPTED
    if as_json:
        print_json([{"design": each.number, "confirmed": each.found.to_dict()} for each in found])
        return 0
    print_confirmed(read_report_data(run_dir, study_of(run_dir)), found)
    out.print(f"the report shows it: codesign report {run_dir}", soft_wrap=True)
    return 0


@commands.command(epilog="Example: `codesign tolerances runs/a --designs recommended --samples 100`")
def tolerances(
    run_dir: RunArgument,
    designs: Annotated[list[str] | None, typer.Option(help="recommended, best, front, spread:N or a number.")] = None,
    samples: Annotated[int, typer.Option(min=1, help="How often each design is made.")] = 100,
    workers: WorkersOption = None,
    as_json: JsonOption = False,
) -> int:
    """Makes designs many times within the study's tolerances: how safety factors and flight scatter."""
    from codesign.cli.console import print_tolerances
    from codesign.followup.tolerances import DEFAULT_DESIGNS, sample_designs

    found = sample_designs(run_dir, designs or DEFAULT_DESIGNS, samples=samples, workers=workers)
    if as_json:
        print_json(json.loads(found.to_json()))
    else:
        print_tolerances(found)
        out.print(f"the report shows them: codesign report {run_dir}", soft_wrap=True)
    return 0


@commands.command(epilog="Example: `codesign reevaluate runs/a --study ironcub_strength --out runs/flown`")
def reevaluate(
    run_dir: RunArgument,
    study: Annotated[str, typer.Option("--study", "-s", help=STUDY_HELP, autocompletion=complete_study)],
    out_dir: Annotated[Path, typer.Option("--out", help="New folder of the run.")],
    designs: Annotated[
        list[str] | None,
        typer.Option(help="recommended, best, front, spread:N or a number; default: front."),
    ] = None,
    workers: WorkersOption = None,
    as_json: JsonOption = False,
) -> int:
    """Evaluates designs of a run under another study of the same variables (other loads, say), as a run of its own."""
    from codesign.chain.study import load_study
    from codesign.cli.extremes import print_extremes
    from codesign.followup.other_study import DEFAULT_DESIGNS, evaluate_under, extremes
    from codesign.search.progress import ProgressBar

    loaded = load_study(study)
    try:
        with ProgressBar(loaded.name) as bar:
            run = evaluate_under(
                loaded, run_dir, designs or DEFAULT_DESIGNS, out=out_dir, workers=workers, progress=bar
            )
    except KeyboardInterrupt:
        err.print(f"continue with: codesign resume {out_dir}")
        return INTERRUPTED
    if not as_json:
        print_extremes(extremes(run))
    return print_run(run, as_json)
