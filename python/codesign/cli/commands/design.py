"""Commands about one design: evaluate, fly, export, view."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer
from rich.table import Table

from codesign.cli.console import err, out, print_evaluation, print_json, print_verdict, shown
from codesign.cli.export.formats import DEFAULT, FORMATS, parse_formats, parse_frames
from codesign.cli.options import (
    DEFAULT_STUDY,
    EXAMPLE_DESIGN,
    JsonOption,
    NoCacheOption,
    SetOption,
    StudyOption,
    TrajectoryOption,
    parse_design,
)
from codesign.errors import DesignError

commands = typer.Typer()


@commands.command(epilog=f"Example: `codesign evaluate {EXAMPLE_DESIGN}`")
def evaluate(
    set_: SetOption = None,
    study: StudyOption = DEFAULT_STUDY,
    trajectory: TrajectoryOption = None,
    confirm: Annotated[bool, typer.Option("--confirm", help="Full parts on fine meshes too, case by case.")] = False,
    no_cache: NoCacheOption = False,
    as_json: JsonOption = False,
) -> int:
    """One design through the whole chain: parts, stress, robot, flight, objectives; known ones from the cache.

    Without --set the study's baseline, or the middle of its grid.
    """
    from codesign.chain.study import load_study
    from codesign.cli.confirmations import print_confirmations
    from codesign.cli.study_summary import typical
    from codesign.report.verdict import study_verdict
    from codesign.storage.cache import default_cache_path, open_cache
    from codesign.storage.designs import evaluate_once

    loaded = load_study(study)
    with open_cache(None if no_cache else default_cache_path(loaded.name), loaded.identity.program) as cache:
        design = parse_design(set_) if set_ else typical(loaded)
        evaluation, known = evaluate_once(loaded, design, cache, trajectory)
    if known:
        err.print("known from the cache; --no-cache computes it again")
    confirmations = loaded.confirm(evaluation.design) if confirm and evaluation.status != "failed" else {}
    if as_json:
        document = evaluation.to_dict()
        if confirm:
            document["confirmed"] = {name: found.confirmed for name, found in confirmations.items()}
            document["confirmation"] = {name: found.cases for name, found in confirmations.items()}
        print_json(document)
    else:
        print_evaluation(evaluation)
        if evaluation.status == "feasible":
            print_verdict(study_verdict(loaded, evaluation).document(), only_reasons=True)
        print_confirmations(evaluation, confirmations)
    return 0 if evaluation.status == "feasible" else 1


@commands.command(epilog="Example: `codesign fly robot.urdf --trajectory envelope --json`")
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
        flight = dict(result["flight"])
        joints = flight.pop("joints")
        for key, value in (flight | flight.pop("saturation")).items():
            table.add_row(key, shown(value))
        for name, peak in joints.items():
            values = (shown(peak[f"peak_{kind}"], 3) for kind in ("torque", "speed", "power"))
            table.add_row(f"{name} at most", "{} N·m, {} rad/s, {} W".format(*values))
        out.print(table)
    return 0 if result["status"] == "completed" else 1


@commands.command(epilog="Example: `codesign export --run runs/a --design recommended --out order`")
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
    formats: Annotated[str, typer.Option(help=f"List with commas of {', '.join(FORMATS)}; log; all.")] = ",".join(
        DEFAULT
    ),
    frames: Annotated[
        str, typer.Option(help="Links without mass in robot files: keep, drop, or tiny (an inertial in URDF).")
    ] = "keep",
    exact_axes: Annotated[
        bool, typer.Option("--exact-axes", help="Robot files: axes nearly along coordinate axes exactly so.")
    ] = False,
    as_json: JsonOption = False,
) -> int:
    """What it takes to make and simulate a design: STL, STEP, 3MF, bill of materials, URDF with meshes, VTU, JSON.

    With --formats also MJCF and SDF with the jets in them, a package for ROS 2, and the flight as CSV, Parquet (log)
    and MCAP.
    """
    from codesign.chain.study import load_study
    from codesign.cli.export.design import design_of_run, export_design
    from codesign.cli.export.folder import MANIFEST
    from codesign.robot.formats.simplified import Simplification

    if (run_dir is None) == (not set_):
        raise DesignError("export needs either a design by --set or a run by --run")
    kinds = parse_formats(formats)
    robot_files = Simplification(parse_frames(frames), exact_axes)
    if run_dir is None:
        chosen = None
        loaded, design = load_study(study), parse_design(set_ or [])
    else:
        chosen = design_of_run(run_dir, selector)
        loaded, design = chosen.study, chosen.design
    written = export_design(
        loaded,
        design,
        out_dir,
        run=chosen,
        organization=organization,
        force=force,
        formats=kinds,
        robot_files=robot_files,
    )
    if as_json:
        print_json({"files": [str(path) for path in written]})
    else:
        for path in written:
            out.print(str(path), soft_wrap=True, highlight=False)
        print_verdict(json.loads((out_dir / MANIFEST).read_text(encoding="utf-8"))["verdict"])
    return 0


@commands.command(epilog="Example: `codesign view runs/a`")
def view(
    run_dir: Annotated[Path | None, typer.Argument(metavar="[DIR]", help="Folder of a run.")] = None,
    set_: Annotated[list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="A design instead.")] = None,
    study: StudyOption = DEFAULT_STUDY,
    trajectory: TrajectoryOption = None,
    port: Annotated[int, typer.Option(help="Local port of the page.")] = 8080,
    record: Annotated[
        Path | None, typer.Option(metavar="FILE.html", help="Write the flight as a page that needs no server instead.")
    ] = None,
) -> int:
    """3-D viewer in the browser: robot, parts colored by stress, flight playback. Ctrl-C ends it."""
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
