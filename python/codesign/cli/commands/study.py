"""Commands about studies: new, check."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from codesign.cli.console import out, print_json, print_study
from codesign.cli.options import DEFAULT_STUDY, JsonOption

commands = typer.Typer()


@commands.command(
    epilog="Example: `codesign new my_study && codesign evaluate --study my_study --set reach=200 --set height=30`"
)
def new(folder: Annotated[Path, typer.Argument(help="New folder for the study.")]) -> int:
    """Writes a commented, runnable study to start from."""
    from codesign.study import new_study

    for path in new_study(folder):
        out.print(str(path), soft_wrap=True, highlight=False)
    return 0


@commands.command(epilog="Example: `codesign check my_study`")
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
