"""What a run costs besides its evaluations does not grow with their number."""

import time
from pathlib import Path

from codesign.execution.pool import Outcome, Task
from codesign.problem.evaluation import Evaluation
from codesign.search.driver import SearchDriver
from codesign.search.settings import Settings
from codesign.storage.store import RunStore
from fake_study import FakeStudy

SIZES = (300, 2400)  # designs before which a stretch of the run is timed
STRETCH = 300


class Bowl(FakeStudy):
    """Three objectives whose front has thousands of designs."""

    objectives = ("a", "b", "c")

    def evaluate(self, design, trajectory=None, cache=None):
        x = [design[v.name] / v.maximum for v in self.space.variables]
        values = {"a": x[0], "b": x[1], "c": (1 - x[0]) ** 2 + (1 - x[1]) ** 2 + (x[2] - 0.5) ** 2}
        return Evaluation(design=dict(design), status="feasible", objectives=values)


class Here:
    """Evaluates in this process."""

    def __init__(self, problem: Bowl) -> None:
        self.problem, self.task = problem, None

    def free(self) -> int:
        return 0 if self.task else 1

    def choose(self, waiting: list[Task]) -> int:
        return 0

    def submit(self, task: Task) -> None:
        self.task = task

    def collect(self, timeout: float) -> list[Outcome]:
        task, self.task = self.task, None
        return [Outcome(task, self.problem.evaluate(task.design), 0.0, "here")]

    def close(self) -> None:
        pass


def test_an_evaluation_costs_the_loop_as_much_late_as_early(tmp_path: Path) -> None:
    problem, spent = Bowl('{"levels": [501, 501, 501]}'), {}

    def note(progress) -> None:
        spent.setdefault(progress.feasible, time.process_time())

    settings = Settings(population=25, evaluations=SIZES[-1] + STRETCH)
    meta = {"variables": [], "objectives": list(problem.objectives), "settings": {}, "study": {}}
    with RunStore.create(tmp_path / "run", meta) as store:
        SearchDriver(problem, settings.plan(problem.space, problem.objectives), store, progress=note).run(
            lambda: Here(problem)
        )
    early, late = (spent[size + STRETCH] - spent[size] for size in SIZES)
    assert late < 2.0 * early, (
        f"{early:.2f} s for the {STRETCH} designs after {SIZES[0]}, {late:.2f} s after {SIZES[1]}"
    )
