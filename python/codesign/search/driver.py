"""The loop of a run: ask, evaluate, store, tell; the same for a fresh and for a resumed run.

Results are told in the order of asking, so neither the number of workers nor the order in which evaluations finish
decides anything. A resumed run goes through the same asks; a design that the store knows is not evaluated again.
"""

from __future__ import annotations

import sys
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

from codesign.errors import StoreError
from codesign.execution.pool import Executor, Outcome, Task
from codesign.problem.evaluation import Evaluation
from codesign.problem.pareto import FrontTracker, rival_of
from codesign.problem.protocols import LazyProblem, PartCache, Problem, Rival
from codesign.problem.quantities import quantity
from codesign.search.base import Grid, Repeatable
from codesign.search.plan import Plan
from codesign.search.progress import Progress
from codesign.search.provenance import session_provenance
from codesign.search.rivals import Rivals
from codesign.storage.designs import keep_evaluation, known_evaluation
from codesign.storage.records import Generation, Record
from codesign.storage.runs import COMPLETE
from codesign.storage.store import RunStore

WAIT = 0.5  # s between looks at the clock while nothing finishes


@dataclass(slots=True)
class _Batch:
    start: int
    grids: list[Grid]


class SearchDriver:
    """One session of a run."""

    def __init__(
        self,
        study: Problem,
        plan: Plan,
        store: RunStore,
        cache: PartCache | None = None,
        progress: Callable[[Progress], None] | None = None,
    ) -> None:
        self._study, self._search, self._schedule, self._stop = study, plan.search, plan.schedule, plan.stop
        self._store, self._cache, self._notify, self._total = store, cache, progress, plan.total
        self._known = store.known()
        self._stored = len(self._known)
        self._asked_before = store.asked()
        self._repeatable = plan.search if isinstance(plan.search, Repeatable) else None
        self._batches: deque[_Batch] = deque()
        self._results: dict[Grid, Evaluation] = {}
        self._grids: list[Grid] = []  # by number
        self._numbers: dict[Grid, int] = {}
        self._told = 0
        self._rivals = Rivals(study.objectives) if plan.lazy and isinstance(study, LazyProblem) else None
        self._told_counts = {"feasible": 0, "infeasible": 0, "skipped": 0, "failed": 0}
        self._counts = dict(self._told_counts)
        for _, status in self._known.values():
            self._counts[status] += 1
        self._cached = 0
        self._queue: list[Task] = []  # by number
        self._running: set[int] = set()
        self._tracker = FrontTracker(study.objectives)
        self._generation: list[Evaluation] = []  # told since the last generation's end
        self._history: list[float | None] = []
        self._ended: str | None = None
        self._earlier = sum(session["seconds"] for session in store.sessions())
        self._began = time.monotonic()
        self._session = 0

    def run(self, executor: Callable[[], Executor]) -> None:
        """Goes on until the search ends; on any exception leaves the store ready to be resumed."""
        self._session = self._store.start_session(session_provenance(self._study))
        workers: Executor | None = None
        outcome = "stopped by an error"
        try:
            self._advance()
            if self._pending():
                workers = executor()
                while self._pending():
                    self._hand_out(workers)
                    self._take(workers.collect(WAIT))
                    self._advance()
            if self._generation:
                self._end_generation()
            outcome = self._ended or COMPLETE[0]
        except KeyboardInterrupt:
            outcome = "interrupted"
            raise
        finally:
            if workers is not None:
                workers.close()
            self._end(outcome)

    def _pending(self) -> bool:
        return bool(self._batches)

    def _elapsed(self) -> float:
        return float(self._earlier + time.monotonic() - self._began)

    def _end(self, outcome: str) -> None:
        failing = sys.exc_info()[0] is not None
        try:
            with self._store.transaction():
                self._store.mark([self._grids[number] for number in self._running], "queued")
                self._store.update_session(self._session, time.monotonic() - self._began, outcome)
        except StoreError:
            if not failing:  # else the first error is the one to see; an open row is queued again by resume
                raise

    def _advance(self) -> None:
        """Asks for what may be asked, then tells the oldest batch if it is complete, until neither is possible.

        Asking goes first: else results known at once (stored, cached) would be told before designs that were asked for
        without them the first time.
        """
        while True:
            while self._ask():
                pass
            if not self._tell():
                self._report()
                return

    def _tell(self) -> bool:
        if not self._batches or any(grid not in self._results for grid in self._batches[0].grids):
            return False
        batch = self._batches.popleft()
        evaluations = [self._results.pop(grid) for grid in batch.grids]
        self._search.tell(batch.grids, evaluations)
        if self._rivals is not None:
            self._rivals.add(batch.start, evaluations)
        self._told += len(evaluations)
        for evaluation in evaluations:
            self._told_counts[evaluation.status] += 1
        self._generation += evaluations
        if len(self._generation) >= self._schedule.first:
            self._end_generation()
        return True

    def _end_generation(self) -> None:
        self._history.append(self._tracker.add(self._generation))
        self._generation = []
        population = tuple(self._numbers[grid] for grid in self._search.population())
        state = Generation(
            len(self._history) - 1,
            self._told,
            **{status: count for status, count in self._told_counts.items() if status != "skipped"},
            hypervolume=self._history[-1],
            population=population,
        )
        self._store.add_generation(state)
        self._store.checkpoint()

    def _ask(self) -> bool:
        asked = len(self._grids)
        count = self._schedule.count(asked, self._told)
        if self._stop.evaluations is not None:
            count = min(count, self._stop.evaluations - asked)
        if count <= 0 or self._ended is not None or self._must_stop(asked):
            return False
        grids = self._next(asked, count)
        if not grids:
            self._ended = COMPLETE[1]
            return False
        self._batches.append(_Batch(asked, grids))
        self._grids += grids
        self._numbers |= zip(grids, range(asked, asked + len(grids)), strict=True)
        self._admit(asked, grids)
        return True

    def _next(self, asked: int, count: int) -> list[Grid]:
        """What the search asks for; of one whose asks need not be repeated, what it asked for the first time."""
        before = self._asked_before[asked : asked + count]
        if self._repeatable is None or asked == 0 or len(before) < count:
            return self._search.ask(count)
        self._repeatable.repeat(before)
        return before

    def _must_stop(self, asked: int) -> bool:
        if asked < len(self._asked_before):  # a resumed run asks again for all that it has
            return False
        if self._stop.stalled(self._history):
            self._ended = f"hypervolume stalled over {self._stop.stall_generations} generations"
        elif self._stop.wall_time is not None and self._elapsed() > self._stop.wall_time:
            self._ended = f"wall time of {self._stop.wall_time:g} s used up"
        return self._ended is not None

    def _admit(self, asked: int, grids: list[Grid]) -> None:
        """Makes rows of newly asked designs; takes from the store and the cache what they have."""
        designs = {grid: self._study.space.from_indices(grid).to_dict() for grid in grids}
        rows = list(enumerate(grids, asked))
        rivals = None if self._rivals is None else self._rivals.front
        new = [(number, grid) for number, grid in rows if grid not in self._known]
        generation = asked // self._schedule.first
        with self._store.transaction():
            self._store.enqueue([(n, generation, grid, designs[grid]) for n, grid in rows], self._study.hash)
            for number, grid in new:
                known = self._known_before(grid, rivals)
                if known is None:
                    self._queue.append(Task(number, designs[grid], rivals=rivals))
                else:
                    self._cached += 1
                    self._keep(Record(number, None, grid, "", known, cached=True))
        for number, grid in enumerate(grids, asked):
            if grid in self._known:
                stored, _ = self._known.pop(grid)
                if stored not in (None, number):
                    raise StoreError(
                        f"{self._store.path}: this program asks for the stored designs in another order; "
                        f"use the versions that the run was made with: {self._store.sessions()[0]['provenance']}"
                    )
                self._results[grid] = self._store.evaluation(grid)

    def _known_before(self, grid: Grid, rivals: tuple[Rival, ...] | None) -> Evaluation | None:
        """The evaluation in the cache, if it is what would be computed now."""
        known = known_evaluation(self._study, grid, self._cache)
        if known is None or rivals is None:
            return known
        whole = known.status == "feasible" and rival_of(rivals, known.objectives.values()) is None
        return known if whole else None

    def _hand_out(self, executor: Executor) -> None:
        while self._queue and executor.free() > 0:
            task = self._queue.pop(executor.choose(self._queue))
            self._running.add(task.number)
            executor.submit(task)
        with self._store.transaction():
            self._store.mark([self._grids[number] for number in self._running], "running")

    def _take(self, outcomes: list[Outcome]) -> None:
        if not outcomes:
            self._report()
            return
        with self._store.transaction():
            for outcome in outcomes:
                number = outcome.task.number
                place = (number, None, self._grids[number], "")
                self._keep(Record(*place, self._evaluation(outcome), False, outcome.worker, outcome.seconds))
                self._running.discard(number)
            self._store.update_session(self._session, time.monotonic() - self._began)
        for outcome in outcomes:
            if self._rivals is None or outcome.evaluation.status == "feasible":  # others lack numbers
                keep_evaluation(self._study, self._grids[outcome.task.number], self._evaluation(outcome), self._cache)

    def _evaluation(self, outcome: Outcome) -> Evaluation:
        return checked(outcome.evaluation, self._study.objectives)

    def _keep(self, record: Record) -> None:
        self._store.finish(record)
        self._results[record.grid] = record.evaluation
        self._counts[record.evaluation.status] += 1

    def _best(self) -> str | None:
        """The best value of a single objective with its unit; empty before any, None where there are several."""
        if len(self._study.objectives) != 1:
            return None
        best = self._tracker.best
        return "" if best is None else quantity(self._study.objectives[0]).text(best)

    def _report(self) -> None:
        if self._notify is None:
            return
        done = sum(self._counts.values())
        state = Progress(
            **self._counts,
            running=len(self._running),
            total=max(self._total, done),
            evaluated_here=done - self._stored - self._cached,
            cached=self._cached,
            seconds=time.monotonic() - self._began,
            generation=len(self._history),
            hypervolume=self._history[-1] if self._history else None,
            best=self._best(),
            ended=self._ended,
        )
        self._notify(state)


def checked(evaluation: Evaluation, objectives: tuple[str, ...]) -> Evaluation:
    """The evaluation, or a failed one if it breaks what every evaluation must hold."""
    problem = None
    if evaluation.status == "feasible":
        missing = [name for name in objectives if name not in evaluation.objectives]
        if missing:
            problem = f"feasible without the objective {missing[0]}"
        elif evaluation.total_violation > 0:
            problem = "feasible with violated constraints"
    elif evaluation.status == "infeasible" and not evaluation.total_violation > 0:
        problem = "infeasible without a violated constraint"
    return Evaluation.failure(evaluation.design, f"inconsistent result: {problem}") if problem else evaluation
