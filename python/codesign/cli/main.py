"""Command line: parse, call, print. Text for people on a terminal, one JSON document on stdout with --json.

Exit codes: 0 done; 1 ran, but the answer is negative (infeasible, failed designs); 2 bad input.
"""

from __future__ import annotations

import logging
import sys
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.table import Table
from rich.text import Text

from codesign import __version__
from codesign.cli.console import (
    err,
    out,
    print_confirmations,
    print_diagnosis,
    print_evaluation,
    print_json,
    print_run,
    print_stress,
    print_study,
    shown,
)
from codesign.errors import CodesignError, DesignError, LibraryError, StudyError

if TYPE_CHECKING:
    from codesign.search.optimization import Resources

app = typer.Typer(
    no_args_is_help=True, add_completion=False, pretty_exceptions_enable=False, rich_markup_mode="markdown"
)

StudyOption = Annotated[str, typer.Option("--study", "-s", help="A shipped study's name or the path of a study.toml.")]
SetOption = Annotated[list[str], typer.Option("--set", metavar="NAME=VALUE", help="A design variable's value.")]
JsonOption = Annotated[bool, typer.Option("--json", help="Print one JSON document on stdout.")]
TrajectoryOption = Annotated[str | None, typer.Option("--trajectory", "-t", help="A trajectory of the study.")]
WorkersOption = Annotated[int | None, typer.Option(min=1, help="Worker processes; default: the study's.")]
ClusterOption = Annotated[str | None, typer.Option(help="Dask scheduler tcp://host:port, or local:N.")]
RunArgument = Annotated[Path, typer.Argument(metavar="DIR", help="Folder of a run.")]
DEFAULT_STUDY = "ironcub"
EXAMPLE_DESIGN = "--set angle=15 --set distance=42 --set offset=80 --set length=108"


def print_version(asked: bool) -> None:
    """Prints the version and ends, if asked."""
    if asked:
        out.print(f"codesign {__version__}", highlight=False)
        raise typer.Exit


@app.callback()
def options(
    version: Annotated[
        bool, typer.Option("--version", callback=print_version, is_eager=True, help="Print the version and end.")
    ] = False,
) -> None:
    """Co-design of parametric parts, robot and controller."""


def parse_design(assignments: list[str]) -> dict[str, float]:
    """Design values from NAME=VALUE texts; raises DesignError for anything else."""
    design: dict[str, float] = {}
    for text in assignments:
        name, equals, value = text.partition("=")
        try:
            number = float(value)
        except ValueError:
            number = float("nan")
        if not equals or number != number:
            raise DesignError(f"--set {text}: expected NAME=NUMBER, for example angle=15")
        if name.strip() in design:
            raise DesignError(f"--set {text}: {name.strip()} is given twice")
        design[name.strip()] = number
    return design


@app.command(epilog=f"Example: `codesign evaluate {EXAMPLE_DESIGN}`")
def evaluate(
    set_: SetOption,
    study: StudyOption = DEFAULT_STUDY,
    trajectory: TrajectoryOption = None,
    confirm: Annotated[bool, typer.Option("--confirm", help="Full parts on fine meshes too (some seconds).")] = False,
    as_json: JsonOption = False,
) -> int:
    """One design through the whole chain: parts, stress, robot, flight, objectives."""
    from codesign.chain.study import load_study

    loaded = load_study(study)
    evaluation = loaded.evaluate(parse_design(set_), trajectory=trajectory)
    confirmations = loaded.confirm(evaluation.design) if confirm and evaluation.status != "failed" else {}
    if as_json:
        confirmed = {"confirmed": {name: c.confirmed for name, c in confirmations.items()}} if confirm else {}
        print_json(evaluation.to_dict() | confirmed)
    else:
        print_evaluation(evaluation)
        print_confirmations(confirmations)
    return 0 if evaluation.status == "feasible" else 1


@app.command(epilog="Example: `codesign fly robot.urdf --trajectory envelope --json`")
def fly(
    robot: Annotated[Path, typer.Argument(help="URDF with the study's joints and jets.")],
    study: StudyOption = DEFAULT_STUDY,
    trajectory: TrajectoryOption = None,
    jets: Annotated[str | None, typer.Option(help="Jet model: integrator or turbine.")] = None,
    as_published: Annotated[bool, typer.Option(help="Accept links with non-physical inertia.")] = False,
    as_json: JsonOption = False,
) -> int:
    """Flies any URDF that has the study's joints and jets."""
    from codesign.chain.fly import fly_robot
    from codesign.chain.study import load_study

    result = fly_robot(load_study(study), robot, trajectory=trajectory, jets=jets, as_published=as_published)
    if as_json:
        print_json(result)
    else:
        table = Table(show_header=False, box=None, pad_edge=False)
        table.add_row("status", result["status"] + (f": {result['reason']}" if result["reason"] else ""))
        for family, values in result["objective_families"].items():
            for key, value in values.items():
                table.add_row(f"{family} {key}", f"{value:.8g}")
        for key, value in result["flight"].items():
            table.add_row(key, shown(value))
        out.print(table)
    return 0 if result["status"] == "completed" else 1


@app.command(epilog="Example: `codesign optimize --population 25 --generations 40 --seed 1 --workers 2 --out runs/a`")
def optimize(
    study: StudyOption = DEFAULT_STUDY,
    population: Annotated[int | None, typer.Option(min=2, help="Designs a generation.")] = None,
    generations: Annotated[int | None, typer.Option(min=1, help="Generations, the start population included.")] = None,
    seed: Annotated[int | None, typer.Option(min=0, help="Decides all that is random; default: the study's.")] = None,
    workers: WorkersOption = None,
    cluster: ClusterOption = None,
    out_dir: Annotated[Path | None, typer.Option("--out", help="New folder of the run.")] = None,
    algorithm: Annotated[
        str | None, typer.Option(help="nsga2, nsga3, agemoea, agemoea2, smsemoa or random; default: the study's.")
    ] = None,
    start: Annotated[str, typer.Option(help="sobol, sobol-plain (as in the paper) or random.")] = "sobol",
    steady: Annotated[bool, typer.Option(help="Offspring without waiting for whole generations.")] = False,
    wall_time: Annotated[float | None, typer.Option(help="Seconds after which no new design is tried.")] = None,
    stall_generations: Annotated[int | None, typer.Option(help="Stop when the hypervolume stands still.")] = None,
    no_cache: Annotated[bool, typer.Option("--no-cache", help="Compute everything again.")] = False,
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
                seed=seed,
                algorithm=algorithm,
                start=start,
                steady=steady,
                wall_time=wall_time,
                stall_generations=stall_generations,
                **resources,
            )
    except ValueError as error:
        raise StudyError(str(error)) from error
    except KeyboardInterrupt:
        err.print(f"interrupted; continue with: codesign resume {folder}")
        return 130
    return print_run(run, as_json)


@app.command(epilog="Example: `codesign resume runs/a`")
def resume(
    run_dir: RunArgument,
    workers: WorkersOption = None,
    cluster: ClusterOption = None,
    evaluations: Annotated[int | None, typer.Option(help="A larger budget than the run had.")] = None,
    as_json: JsonOption = False,
) -> int:
    """Continues an interrupted run, as if it had never stopped."""
    from codesign.search.optimization import resume as run_resume
    from codesign.search.progress import ProgressBar

    try:
        with ProgressBar(run_dir.name) as bar:
            run = run_resume(run_dir, workers=workers, cluster=cluster, evaluations=evaluations, progress=bar)
    except KeyboardInterrupt:
        err.print(f"interrupted; continue with: codesign resume {run_dir}")
        return 130
    return print_run(run, as_json)


@app.command("runs", epilog="Example: `codesign runs runs --json`")
def runs_command(
    folder: Annotated[Path, typer.Argument(help="Folder that holds runs, at any depth.")] = Path("runs"),
    compare: Annotated[bool, typer.Option(help="Compare their fronts in one common box.")] = False,
    as_json: JsonOption = False,
) -> int:
    """Lists the runs in a folder, or compares their fronts."""
    from codesign.storage.runs import compare_runs, find_runs, list_runs, load_run

    rows = compare_runs([load_run(run) for run in find_runs(folder)]) if compare else list_runs(folder)
    if as_json:
        print_json(rows)
        return 0
    table = Table()
    columns = ("run", "study", "algorithm", "seed", "designs", "front", "hypervolume", "seconds", "outcome")
    for name in columns:
        table.add_column(name)
    for row in rows:
        values = [row.get(name, "") for name in columns]
        table.add_row(*(f"{v:.5g}" if isinstance(v, float) else str(v) for v in values))
    out.print(table)
    return 0


@app.command(epilog="Example: `codesign report runs/a`")
def report(run_dir: RunArgument, as_json: JsonOption = False) -> int:
    """One self-contained HTML page and the figures of a run."""
    from codesign.report import write_report

    paths = write_report(run_dir)
    if as_json:
        print_json({"page": str(paths.html), "figures": [str(path) for path in paths.figures]})
    else:
        out.print(f"report: {paths.html.resolve()}", soft_wrap=True)
    return 0


@app.command(epilog="Example: `codesign export --run runs/a --design recommended --out order`")
def export(
    out_dir: Annotated[Path, typer.Option("--out", help="Folder for the files; created.")],
    set_: Annotated[
        list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="A design variable's value.")
    ] = None,
    run_dir: Annotated[Path | None, typer.Option("--run", metavar="DIR", help="A design of this run instead.")] = None,
    selector: Annotated[str, typer.Option("--design", help="Of the run: recommended or a number.")] = "recommended",
    study: StudyOption = DEFAULT_STUDY,
    organization: Annotated[str, typer.Option(help="For the files' headers; default: the study's title.")] = "",
    force: Annotated[bool, typer.Option("--force", help="Replace the export of another design.")] = False,
    as_json: JsonOption = False,
) -> int:
    """What it takes to make and simulate a design: STL, STEP, 3MF, bill of materials, URDF with meshes, VTU, JSON."""
    from codesign.chain.study import load_study
    from codesign.cli.design import design_of_run, export_design

    if (run_dir is None) == (not set_):
        raise DesignError("export needs either a design by --set or a run by --run")
    if run_dir is None:
        loaded, design, chosen = load_study(study), parse_design(set_ or []), ""
    else:
        loaded, design, chosen = design_of_run(run_dir, selector)
    written = export_design(loaded, design, out_dir, chosen=chosen, organization=organization, force=force)
    if as_json:
        print_json({"files": [str(path) for path in written]})
    else:
        for path in written:
            out.print(str(path), soft_wrap=True, highlight=False)
    return 0


@app.command(
    epilog="Example: `codesign new my_study && codesign evaluate --study my_study --set reach=200 --set height=30`"
)
def new(folder: Annotated[Path, typer.Argument(help="New folder for the study.")]) -> int:
    """Writes a commented, runnable study to start from."""
    from codesign.study import new_study

    for path in new_study(folder):
        out.print(str(path), soft_wrap=True, highlight=False)
    return 0


@app.command(epilog="Example: `codesign check my_study`")
def check(
    study: Annotated[str, typer.Argument(help="A shipped study's name or the path of a study.toml.")] = DEFAULT_STUDY,
    as_json: JsonOption = False,
) -> int:
    """Everything that is wrong with a study, at once; else what varies, what is minimized and what must hold."""
    from codesign.chain.judge import limits
    from codesign.chain.study import load_study
    from codesign.study.loading import find_problems

    problems = find_problems(study)
    if as_json:
        print_json({"problems": problems})
    elif problems:
        for problem in problems:
            out.print(problem, soft_wrap=True)
    else:
        loaded = load_study(study)
        print_study(loaded.space, loaded.objectives, [limit.quantity.title for limit in limits(loaded.config)])
    return 1 if problems else 0


@app.command(epilog="Example: `codesign validate runs/a --designs recommended --designs best`")
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


@app.command(epilog="Example: `codesign view runs/a`")
def view(
    run_dir: Annotated[Path | None, typer.Argument(metavar="[DIR]", help="Folder of a run.")] = None,
    set_: Annotated[list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="A design instead.")] = None,
    study: StudyOption = DEFAULT_STUDY,
    trajectory: TrajectoryOption = None,
    port: Annotated[int, typer.Option(help="Of the page on this machine.")] = 8080,
    record: Annotated[
        Path | None, typer.Option(metavar="FILE.html", help="Write the flight as a page that needs no server instead.")
    ] = None,
) -> int:
    """3-D viewer in the browser: robot, parts coloured by stress, flight playback. Ctrl-C ends it."""
    from codesign.chain.study import load_study
    from codesign.viewer import viewer

    if (run_dir is None) == (not set_):
        raise DesignError("view needs either the folder of a run or a design by --set")
    design = parse_design(set_) if set_ else None
    shown = load_study(study) if design else None
    if record is not None:
        written = viewer.record(record, shown, design, run_directory=run_dir, trajectory=trajectory)
        out.print(str(written), soft_wrap=True, highlight=False)
        return 0
    running = viewer.view(shown, design, run_directory=run_dir, trajectory=trajectory, port=port)
    print(f"viewer: {running.address} (Ctrl-C ends it)", flush=True)  # noqa: T201 - at once, also into a pipe
    running.wait()
    return 0


@app.command(epilog="Example: `codesign stress part.stl --scale 1e-3 --fix near:0,0,0 --load 'normal:0,0,1: 0 0 -250'`")
def stress(
    part: Annotated[Path, typer.Argument(metavar="PART", help="Closed surface: STL, binary or ASCII, or a STEP file.")],
    fix: Annotated[list[str], typer.Option(metavar="SEL", help="Held in all directions; may be repeated.")],
    load: Annotated[list[str], typer.Option(metavar="'SEL: FX FY FZ'", help="Total force in N; may be repeated.")],
    scale: Annotated[float, typer.Option(help="Metres per unit of an STL file and of the selections.")] = 1e-3,
    material: Annotated[
        str, typer.Option(help="ergal, aluminium_6061_t6, steel_s235, titanium_ti6al4v, or E_GPa,nu,yield_MPa[,kg/m3].")
    ] = "ergal",
    edge_length: Annotated[
        float | None, typer.Option(metavar="MM", help="Of the elements; default: from the wall thickness.")
    ] = None,
    vtu: Annotated[Path | None, typer.Option(help="Where to write displacement and stress, for ParaView.")] = None,
    png: Annotated[Path | None, typer.Option(help="Where to write a picture of the stressed part.")] = None,
    exclusion: Annotated[
        float | None,
        typer.Option(metavar="MM", help="No peak is read nearer to borders of clamps; default: a fifth of the wall"),
    ] = None,
    smooth: Annotated[
        bool, typer.Option("--smooth", help="The file is a coarse tessellation of curved faces: curve its facets back.")
    ] = False,
    repair: Annotated[
        bool,
        typer.Option(
            "--repair", help="Make one solid of a file with doubled or turned facets, gaps, overlapping bodies."
        ),
    ] = False,
    no_simplify: Annotated[
        bool, typer.Option("--no-simplify", help="Keep edges that are tiny (0.05 mm) beside the elements.")
    ] = False,
    as_json: JsonOption = False,
) -> int:
    """Safety factor of any closed surface; exit code 1 if the material yields.

    SEL is near:x,y,z (the smooth face nearest to a point), box:x0,y0,z0,x1,y1,z1 (all faces inside) or
    normal:nx,ny,nz[:degrees] (faces that look there), in the file's units.
    """
    from codesign.cli.stress import stress_document
    from codesign.cli.stress_options import find_material

    document = stress_document(
        part,
        scale,
        find_material(material),
        fix,
        load,
        edge_length,
        vtu,
        png,
        exclusion,
        smooth,
        repair,
        not no_simplify,
    )
    if as_json:
        print_json(document)
    else:
        print_stress(document)
    factor = document["safety_factor"]
    return 0 if factor is None or factor >= 1.0 else 1


@app.command(epilog="Example: `codesign doctor`")
def doctor(as_json: JsonOption = False) -> int:
    """Versions, BLAS in use, cores; what is missing, too old or cannot be loaded."""
    from codesign.cli.doctor import diagnose

    report = diagnose()
    if as_json:
        print_json(report)
    else:
        print_diagnosis(report)
    return 1 if report["problems"] else 0


def main() -> None:
    """Entry point: runs the command line and turns typed errors into exit code 2."""
    logging.basicConfig(level=logging.WARNING, stream=sys.stderr, format="%(levelname)s %(name)s: %(message)s")
    command = typer.main.get_command(app)
    try:
        code = command.main(standalone_mode=False)
    except (CodesignError, ImportError) as problem:
        error = LibraryError.of(problem) if isinstance(problem, ImportError) else problem
        if "--json" in sys.argv:
            print_json({"error": {"type": type(error).__name__, "message": str(error)}})
        err.print(Text.assemble((type(error).__name__, "bold red"), f": {error}"), soft_wrap=True)
        code = 2
    except typer.Exit as stop:
        code = stop.exit_code
    except Exception as error:
        if not hasattr(error, "exit_code") or not hasattr(error, "show"):
            raise
        error.show()
        code = 2
    except KeyboardInterrupt:
        err.print("interrupted")
        code = 130
    sys.exit(code if isinstance(code, int) else 0)
