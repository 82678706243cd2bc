"""Commands about studies: new, check, tune, schema."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from codesign.cli.console import out, print_json
from codesign.cli.options import (
    DEFAULT_STUDY,
    JsonOption,
    StudyArgument,
    TrajectoryOption,
    complete_study,
    parse_design,
)
from codesign.errors import StudyError

commands = typer.Typer()


@commands.command(
    epilog="Example: `codesign new my_study && codesign evaluate --study my_study --set reach=200 --set height=30`, "
    "or `codesign new dog --urdf go1.urdf --mount FL_thigh,FR_thigh,RL_thigh,RR_thigh`"
)
def new(
    folder: Annotated[Path, typer.Argument(help="New folder for the study.")],
    urdf: Annotated[Path | None, typer.Option(help="A robot that is to fly; without it, a shipped study.")] = None,
    jets: Annotated[str, typer.Option(help="Links of it that push, by commas; default: a multirotor's, by name.")] = "",
    mount: Annotated[str, typer.Option(help="Links that get an arm with a jet each, by commas.")] = "",
    count: Annotated[int, typer.Option(min=1, max=32, help="Jets around it, if neither is given or found.")] = 6,
    template: Annotated[
        str,
        typer.Option("--from", help="Shipped study to copy, with all that it extends.", autocompletion=complete_study),
    ] = "",
) -> int:
    """Writes a commented, runnable study to start from: a shipped one, or jets on arms for a robot of yours."""
    from codesign.study import new_study
    from codesign.study.own_robot import study_of_robot

    if urdf is None:
        if jets or mount:
            raise StudyError("--jets and --mount name links of the robot that --urdf gives")
        files = new_study(folder, template or "gimbal_quad")
    else:
        if template:
            raise StudyError("--from copies a shipped study; a study for --urdf is written anew")
        written = study_of_robot(folder, urdf, _names(jets), _names(mount), count)
        files = written.files
        for note in written.notes:
            out.print(note, soft_wrap=True, highlight=False)
    for path in files:
        out.print(str(path), soft_wrap=True, highlight=False)
    out.print(f"next: codesign check {folder}", soft_wrap=True, highlight=False)
    return 0


def _names(given: str) -> list[str]:
    return [name.strip() for name in given.split(",") if name.strip()]


@commands.command(epilog="Example: `codesign check my_study --time`")
def check(
    study: StudyArgument = DEFAULT_STUDY,
    time: Annotated[
        bool, typer.Option("--time", help="Evaluate three designs, too: what they cost, what never changes.")
    ] = False,
    as_json: JsonOption = False,
) -> int:
    """Everything that is wrong with a study, at once; else what varies, what is minimized and what must hold.

    A robot that cannot hover or hold its attitude at its start posture is wrong, too, and a part that no values give.

    Exit code 2 if anything is wrong.
    """
    from codesign.chain.study import load_study
    from codesign.cli.study_summary import hopeless, measured, print_study, study_summary, typical
    from codesign.study.checking.everything import find_problems
    from codesign.study.checking.ranges import refused_values

    problems = find_problems(study)
    loaded = None if problems else load_study(study)
    refusals = list(refused_values(loaded, typical(loaded))) if loaded is not None else []
    if loaded is not None:
        problems = [f"{loaded.path}: {key}: {reason}" for key, reason in hopeless(loaded, refusals)]
    if problems or loaded is None:
        if as_json:
            print_json({"problems": problems})
        for problem in [] if as_json else problems:
            out.print(problem, soft_wrap=True)
        return 2
    summary = study_summary(loaded, refusals) | ({"evaluation": measured(loaded)} if time else {})
    if as_json:
        print_json({"problems": [], **summary})
    else:
        print_study(summary)
    return 0


@commands.command(epilog="Example: `codesign tune my_study`")
def tune(
    study: StudyArgument = DEFAULT_STUDY,
    set_: Annotated[
        list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="A design; default: the baseline.")
    ] = None,
    trajectory: TrajectoryOption = None,
    as_json: JsonOption = False,
) -> int:
    """Flies a design with gains of several bandwidths, and prints what came of it and the best ones.

    Gains are computed from mass, inertia and bandwidth (docs/control.md). Exit code 1 if all flights were
    lost.
    """
    from codesign.chain.study import load_study
    from codesign.chain.tuning import recommended
    from codesign.chain.tuning import tune as tune_study
    from codesign.cli.study_summary import typical
    from codesign.cli.tuning import print_tuning, tuning_document

    loaded = load_study(study)
    design = loaded.space.design(parse_design(set_)) if set_ else typical(loaded)
    trials = tune_study(loaded, design, trajectory)
    chosen = recommended(trials)
    if as_json:
        print_json(tuning_document(trials, chosen))
    else:
        print_tuning(trials, chosen)
    return 1 if chosen is None else 0


@commands.command(epilog="Example: `codesign schema > study.schema.json`")
def schema() -> int:
    """JSON Schema of study.toml, for editors: `#:schema study.schema.json` in its first line."""
    from codesign.study.reference import study_schema

    print_json(study_schema())
    return 0
