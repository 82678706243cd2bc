"""Searches of other people: found by address or entry point, resumed like any other."""

import importlib.metadata
from dataclasses import dataclass

import pytest

from codesign.search.optimization import optimize, resume
from codesign.search.registry import BUILT_IN, ENTRY_POINTS, SearchKind, find_search
from codesign.search.settings import Settings
from fake_study import study


@dataclass(frozen=True)
class DiagonalOptions:
    stride: int = 1


class Diagonal:
    """Walks along the diagonal of the grid: a search in one file."""

    def __init__(self, levels, stride):
        self.todo = [tuple(i % n for n in levels) for i in range(0, max(levels), stride)]

    def ask(self, count):
        batch, self.todo = self.todo[:count], self.todo[count:]
        return batch

    def tell(self, grids, evaluations):
        pass

    def population(self):
        return []


DIAGONAL = SearchKind(
    lambda space, _objectives, _settings, options: Diagonal(space.levels, options.stride), options=DiagonalOptions
)
ADDRESS = "test_registry:DIAGONAL"


def test_a_search_in_one_file_runs_and_resumes(tmp_path):
    run = optimize(
        study(), out=tmp_path / "run", algorithm=ADDRESS, options={"stride": 2}, evaluations=4, workers=1, cache=None
    )
    assert [record.grid for record in run.records] == [(0, 0, 0), (2, 2, 2), (4, 4, 4), (6, 6, 0)]
    more = resume(tmp_path / "run", evaluations=6, workers=1)
    assert [record.grid for record in more.records][4:] == [(8, 8, 2), (10, 10, 4)]


def test_a_search_of_an_installed_package_is_found_by_its_name(monkeypatch):
    point = importlib.metadata.EntryPoint("diagonal", ADDRESS, ENTRY_POINTS)
    monkeypatch.setattr("codesign.search.registry.entry_points", lambda group: [point] if group == ENTRY_POINTS else [])
    assert find_search("diagonal") is DIAGONAL


@pytest.mark.parametrize("name", sorted(BUILT_IN))
def test_every_built_in_search_is_there(name):
    assert isinstance(find_search(name), SearchKind)


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"algorithm": "nsga4"}, "did you mean 'nsga"),
        ({"algorithm": "no_such_module:KIND"}, "No module named"),
        ({"algorithm": "test_registry:Diagonal"}, "is not a codesign"),
        ({"algorithm": ADDRESS, "options": {"step": 1}}, "option 'step': this search has stride"),
        ({"algorithm": "random", "options": {"eta": 1.0}}, "no options"),
    ],
)
def test_what_is_no_search_is_refused_with_the_nearest_name(settings, message):
    fake = study()
    with pytest.raises(ValueError, match=message):
        Settings(**settings).search(fake.space, fake.objectives)
