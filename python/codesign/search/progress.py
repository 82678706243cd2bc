"""State of a running search, and its display on a terminal."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass
from types import TracebackType
from typing import Any, Self

LEAST_BAR = 10  # columns of a bar that is worth showing
SPARE = ("rate", "cached", "skipped", "infeasible", "reached", "failed", "feasible")  # what gives way to a narrow line


@dataclass(frozen=True, slots=True)
class Progress:
    """What a run has done so far; `seconds` and `evaluated_here` count this session only.

    best: value of a single objective in words, "" before there is one; None where there are several objectives.
    """

    feasible: int
    infeasible: int
    failed: int
    running: int
    total: int
    evaluated_here: int
    seconds: float
    cached: int = 0
    skipped: int = 0
    generation: int = 0
    hypervolume: float | None = None
    best: str | None = None
    ended: str | None = None

    @property
    def done(self) -> int:
        """Designs with a result."""
        return self.feasible + self.infeasible + self.skipped + self.failed

    @property
    def rate(self) -> float:
        """Evaluations per second in this session, designs found in the cache not counted."""
        return self.evaluated_here / self.seconds if self.seconds > 0 else 0.0

    @property
    def seconds_left(self) -> float | None:
        """Estimated time left [s] at the mean rate of this session; None before the first evaluation."""
        done_here = self.evaluated_here + self.cached
        return (self.total - self.done) * self.seconds / done_here if done_here else None


class ProgressBar:
    """A live line on standard error: use in a `with` block and pass the object as `progress`.

    A narrow terminal has it without the bar, then without what matters least.
    """

    def __init__(self, title: str = "optimize", interval: float = 0.2) -> None:
        from rich.console import Console
        from rich.progress import BarColumn, TextColumn
        from rich.progress import Progress as Display

        self._console, self._title = Console(stderr=True), title
        text = TextColumn("{task.fields[state]}", markup=False)
        self._wide = [TextColumn(title, style="bold", markup=False), BarColumn(None), text]
        self._display = Display(*self._wide, console=self._console)
        self._task = self._display.add_task(title, total=None, state="starting workers")
        self._interval, self._shown = interval, 0.0
        self._last: Progress | None = None

    def __enter__(self) -> Self:
        self._display.start()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        if self._last is not None:
            self._show(self._last)
        self._display.stop()

    def __call__(self, progress: Progress) -> None:
        """Shows the state, at most a few times per second."""
        self._last = progress
        now = time.monotonic()
        if now - self._shown >= self._interval or progress.done == progress.total:
            self._shown = now
            self._show(progress)

    def _show(self, progress: Progress) -> None:
        width = self._console.width
        room = width - len(self._title) - LEAST_BAR - 3
        bar = len(describe(progress)) <= room
        self._display.columns = tuple(self._wide if bar else self._wide[-1:])
        state = describe(progress, room if bar else width - 1)
        values: dict[str, Any] = {"total": progress.total, "completed": progress.done, "state": state}
        self._display.update(self._task, **values)


def describe(progress: Progress, width: int | None = None) -> str:
    """One line: counts, rate, hypervolume (of a single objective the best value), time left.

    width: columns that there are; what matters least is left out then.
    """
    hypervolume = "—" if progress.hypervolume is None else f"{progress.hypervolume:.4f}"
    reached = f"hypervolume {hypervolume}" if progress.best is None else f"best {progress.best or '—'}"
    left = progress.seconds_left
    parts = {
        "done": f"{progress.done}/{progress.total}",
        "rate": f"{progress.rate:.2f}/s" if progress.rate < 10 else f"{progress.rate:.0f}/s",
        "cached": f"cached {progress.cached}" if progress.cached else "",
        "feasible": f"feasible {progress.feasible}",
        "infeasible": f"infeasible {progress.infeasible}",
        "skipped": f"skipped {progress.skipped}" if progress.skipped else "",
        "failed": f"failed {progress.failed}",
        "reached": reached,
        "left": f"left {duration(left)}" if left is not None else "left —",
    }
    for name in SPARE:
        if width is None or len(_line(parts)) <= width:
            break
        del parts[name]
    return _line(parts)


def _line(parts: Mapping[str, str]) -> str:
    return "  ".join(part for part in parts.values() if part)


def duration(seconds: float) -> str:
    """`1:02:03` or `2:03`."""
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{rest:02d}" if hours else f"{minutes}:{rest:02d}"
