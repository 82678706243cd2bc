"""When a search is asked, and when it ends."""

from __future__ import annotations

from dataclasses import dataclass

from codesign.search.base import Search


@dataclass(frozen=True, slots=True)
class Schedule:
    """When to ask: `first` designs at the start; once these are told, `batch` at a time, at most `window` pending.

    Batches are told whole. batch = window: a barrier, generations if both are `first` (the default). batch = 1: steady
    state.
    """

    first: int
    batch: int | None = None
    window: int | None = None

    def count(self, asked: int, told: int) -> int:
        """Designs to ask for now."""
        batch, window = self.batch or self.first, self.window or self.first
        if asked == 0:
            return self.first
        waiting_for_start = told == 0
        return 0 if waiting_for_start or asked - told + batch > window else batch


@dataclass(frozen=True, slots=True)
class Termination:
    """When to ask no more: after `evaluations` designs, `wall_time` [s], or `stall_generations` without progress."""

    evaluations: int | None = None
    wall_time: float | None = None
    stall_generations: int | None = None
    stall_tolerance: float = 1e-3

    def stalled(self, history: list[float | None]) -> bool:
        """Whether the hypervolume grew by less than the tolerance (relative) over the last generations."""
        span = self.stall_generations
        if span is None or len(history) <= span:
            return False
        before, now = history[-span - 1], history[-1]
        return before is not None and now is not None and now - before <= self.stall_tolerance * abs(before)


@dataclass(frozen=True, slots=True)
class Plan:
    """A search, when it asks, when it ends, how many designs it will ask for at most, whether they are lazy."""

    search: Search
    schedule: Schedule
    stop: Termination
    total: int
    lazy: bool = False
