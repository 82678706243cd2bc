"""What every evolutionary search must hold, whichever package it comes from."""

import random

import numpy as np

from codesign.search.settings import Settings
from fake_study import FakeStudy, study

WITH_NUMBA = {"agemoea", "agemoea2"}  # searches that need the extra `age`; tests/consumers runs them


def tell_all(search, space: FakeStudy, count: int, batch: int) -> list[tuple[int, ...]]:
    """Runs a search without workers or store."""
    asked: list[tuple[int, ...]] = []
    while len(asked) < count and (grids := search.ask(batch)):
        asked += grids
        search.tell(grids, [space.evaluate(space.space.from_indices(grid)) for grid in grids])
    return asked


def check_evolution(algorithm: str, batch: int) -> None:
    """The same seed asks for the same designs, whatever global generators say, and for none of them twice."""
    fake = study()
    settings = Settings(algorithm, population=12, seed=3)
    runs = []
    for _ in range(2):
        search = settings.search(fake.space, fake.objectives)
        runs.append(tell_all(search, fake, 120, batch))
        np.random.seed(len(runs))  # noqa: NPY002
        random.seed(len(runs))
    assert runs[0] == runs[1]
    assert len(set(runs[0])) == len(runs[0]) >= 120
    assert len(search.population()) == 12
