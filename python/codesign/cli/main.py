"""The command line: text for people on a terminal, one JSON document on stdout with --json.

Exit codes: 0 done; 1 ran, but the answer is negative (infeasible, failed designs); 2 bad input; 130 interrupted.
"""

from __future__ import annotations

import copy
import inspect
import logging
import os
import sys
from contextlib import AbstractContextManager, nullcontext
from typing import Annotated

import typer
from rich.text import Text

from codesign import __version__
from codesign.cli.commands import design, doctor, run, stress, study
from codesign.cli.console import err, out, print_json
from codesign.cli.options import INTERRUPTED
from codesign.errors import CodesignError, FileError, LibraryError

app = typer.Typer(no_args_is_help=True, pretty_exceptions_enable=False, rich_markup_mode="markdown")
for group in (design, run, study, stress, doctor):
    app.add_typer(group.commands)


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


def listing() -> typer.Typer:
    """The commands by their words alone: for a list of them their options need not be read, which takes as long again.

    That is what `--help` of the whole prints; it is the same text.
    """
    listed = copy.copy(app)
    listed.registered_groups, listed.registered_commands = [], []
    for group in app.registered_groups:
        for command in group.typer_instance.registered_commands if group.typer_instance else ():
            assert command.callback is not None
            words = copy.copy(command)
            words.name = command.name or command.callback.__name__.replace("_", "-")
            words.help = command.help or inspect.getdoc(command.callback)
            words.callback = _no_command
            listed.registered_commands.append(words)
    return listed


def _no_command() -> None:
    """Stands for a command whose options nobody asks for."""


def main() -> None:
    """Entry point: runs the command line and turns typed errors into exit code 2."""
    logging.basicConfig(level=logging.WARNING, stream=sys.stderr, format="%(levelname)s %(name)s: %(message)s")
    command = typer.main.get_command(listing() if sys.argv[1:] == ["--help"] else app)
    try:
        with _interruptible():
            code = command.main(standalone_mode=False)
    except BrokenPipeError:  # whoever read the output has ended
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        code = 1
    except (CodesignError, ImportError, OSError) as problem:
        error = _typed(problem)
        if "--json" in sys.argv:
            print_json({"error": {"type": type(error).__name__, "message": str(error)}})
        err.print(Text.assemble((type(error).__name__, "bold red"), f": {error}"), soft_wrap=True)
        code = 2
    except typer.Exit as stop:
        code = stop.exit_code
    except (KeyboardInterrupt, typer.Abort):
        code = INTERRUPTED
    except Exception as error:
        if not hasattr(error, "exit_code") or not hasattr(error, "show"):
            raise
        error.show()
        code = 2
    if code == INTERRUPTED:  # also what typer makes of KeyboardInterrupt
        err.print("interrupted")
    sys.exit(code if isinstance(code, int) else 0)


def _interruptible() -> AbstractContextManager[None]:
    """What ends long commands on Ctrl-C; help and version compute nothing and do without the native code."""
    if len(sys.argv) == 1 or {"--help", "--version"} & set(sys.argv):
        return nullcontext()
    from codesign.interrupts import guarded

    return guarded()


def _typed(problem: CodesignError | ImportError | OSError) -> CodesignError:
    """The error that a user is told, in one line."""
    if isinstance(problem, ImportError):
        return LibraryError.of(problem)
    if isinstance(problem, OSError):
        where = f"{problem.filename}: " if problem.filename else ""
        return FileError(f"{where}{problem.strerror or problem}")
    return problem
