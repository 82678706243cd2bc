"""The command about the installation: doctor."""

from __future__ import annotations

import typer

from codesign.cli.console import print_diagnosis, print_json
from codesign.cli.options import JsonOption

commands = typer.Typer()


@commands.command(epilog="Example: `codesign doctor`")
def doctor(as_json: JsonOption = False) -> int:
    """Versions, BLAS in use, cores; what is missing, too old or cannot be loaded."""
    from codesign.cli.doctor import diagnose

    report = diagnose()
    if as_json:
        print_json(report)
    else:
        print_diagnosis(report)
    return 1 if report["problems"] else 0
