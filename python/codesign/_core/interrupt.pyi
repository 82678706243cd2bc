"""
What Ctrl-C does to long computations.
"""

from __future__ import annotations
import os
import typing

__all__: list[str] = ["acknowledge", "add_temporary", "remove_temporary", "start_guard", "stop_threads"]

def acknowledge() -> None:
    """
    Python has taken note of the interrupts so far.
    """

def add_temporary(path: os.PathLike | str | bytes) -> None:
    """
    A file or folder to be removed if the guard ends the process.
    """

def remove_temporary(path: os.PathLike | str | bytes) -> None: ...
def start_guard(
    descriptor: typing.SupportsInt | typing.SupportsIndex, grace: typing.SupportsFloat | typing.SupportsIndex
) -> None:
    """
    Ends the process with exit code 130 if an interrupt read from the descriptor is not acknowledged within `grace` seconds; a zero byte ends the watch.
    """

def stop_threads(stop: bool) -> None:
    """
    Has computations on other threads than the main one end with KeyboardInterrupt.
    """
