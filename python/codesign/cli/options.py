"""Options and arguments that several commands have."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from codesign.errors import DesignError

if TYPE_CHECKING:
    from codesign.problem.design_space import DesignValue


def complete_study(incomplete: str) -> list[str]:
    """Names of shipped studies that begin so, for the shell."""
    from codesign.study import shipped_studies

    return [name for name in shipped_studies() if name.startswith(incomplete)]


def complete_assignment(context: typer.Context, incomplete: str) -> list[str]:
    """Design variables that begin so, of the study that the line names, for the shell."""
    from codesign.study import StudyData, load

    study = load(context.params.get("study") or DEFAULT_STUDY, StudyData)
    return [f"{name}=" for name in study.space.names if f"{name}=".startswith(incomplete)]


STUDY_HELP = "A shipped study's name, or the path of a study.toml or of its folder."
StudyOption = Annotated[str, typer.Option("--study", "-s", help=STUDY_HELP, autocompletion=complete_study)]
StudyArgument = Annotated[str, typer.Argument(help=STUDY_HELP, autocompletion=complete_study)]
SetOption = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="NAME=VALUE",
        help="A design variable's value; default: the baseline.",
        autocompletion=complete_assignment,
    ),
]
JsonOption = Annotated[bool, typer.Option("--json", help="Print one JSON document on stdout.")]
NoCacheOption = Annotated[bool, typer.Option("--no-cache", help="Compute everything again.")]
TrajectoryOption = Annotated[str | None, typer.Option("--trajectory", "-t", help="A trajectory of the study.")]
WorkersOption = Annotated[int | None, typer.Option(min=1, help="Worker processes; default: the study's.")]
ClusterOption = Annotated[str | None, typer.Option(help="Dask scheduler tcp://host:port, or local:N.")]
RunArgument = Annotated[Path, typer.Argument(metavar="DIR", help="Folder of a run.")]
DEFAULT_STUDY = "ironcub"
INTERRUPTED = 130  # exit code
EXAMPLE_DESIGN = "--study ironcub_paper --set angle=15 --set distance=42 --set offset=80 --set length=108"


def parse_design(assignments: list[str]) -> dict[str, DesignValue]:
    """Design values from NAME=VALUE texts, numbers where they are some; raises DesignError for anything else."""
    design: dict[str, DesignValue] = {}
    for text in assignments:
        name, equals, value = (part.strip() for part in text.partition("="))
        if not equals or not value:
            raise DesignError(f"--set {text}: expected NAME=VALUE, for example angle=15")
        if name in design:
            raise DesignError(f"--set {text}: {name} is given twice")
        try:
            design[name] = float(value)
        except ValueError:
            design[name] = value
    return design
