"""Which evaluation a worker takes: what it has kept meshes of; results and rows do not depend on it."""

import random

import pytest

import codesign
from codesign.execution.affinity import LOOK, best, keys_of, waste
from codesign.execution.pool import LocalPool, StudyRef, Task
from codesign.search.optimization import optimize
from fake_study import study

GROUPS = (("a",), ("b", "c"))


def test_keys_name_the_values_that_a_mesh_depends_on():
    design = {"a": 1.0, "b": 2.0, "c": "steel", "d": 5.0}
    assert keys_of(design, GROUPS) == {(0, (1.0,)), (1, (2.0, "steel"))}
    assert keys_of(design, ()) == frozenset()


def test_what_others_have_kept_goes_last_and_what_nobody_has_first():
    mine, others, new = (0, (1,)), (0, (2,)), (0, (3,))
    costs = [waste(frozenset([key]), {mine}, {others}) for key in (new, mine, others)]
    assert costs == sorted(costs) and len(set(costs)) == 3
    assert best([frozenset([others]), frozenset([mine])], [{mine}, {others}], [0]) == (1, 0)
    assert best([frozenset([others])], [{mine}, {others}], [0, 1]) == (0, 1)
    assert best([frozenset(), frozenset()], [set(), set()], [1, 0]) == (0, 0)


def made_twice(chosen: bool) -> int:
    """Meshes that a worker makes although another has them: 40 generations of 25 designs, 4 workers in turn."""
    draw = random.Random(3)
    kept: list[set] = [set() for _ in range(4)]
    for generation in range(40):
        designs = [{"a": draw.gauss(0, 6) // 1, "b": draw.gauss(0, 2) // 1, "c": 0} for _ in range(25)]
        needed = [keys_of(design, GROUPS) for design in designs]
        for turn in range(25):
            worker = (turn + generation) % 4
            task = best(needed, kept, [worker])[0] if chosen else 0
            kept[worker] |= needed.pop(task)
    return sum(map(len, kept)) - len(set().union(*kept))


def test_fewer_meshes_are_made_twice():
    assert made_twice(chosen=True) < 0.75 * made_twice(chosen=False)


def test_a_pool_chooses_for_the_worker_that_is_idle():
    fake = study()
    fake.mesh_groups = (("a",),)
    waiting = [Task(n, {"a": a}) for n, a in enumerate([2.0, 2.0, 1.0, 2.0])]
    with LocalPool(StudyRef.of(fake), 2) as pool:
        assert pool.choose(waiting) == 0
        busy = pool._workers[0]
        busy.kept, busy.task = {(0, (2.0,))}, Task(9, {})
        assert pool.choose(waiting) == 2
        late = [waiting[0], Task(LOOK, {"a": 1.0})]
        assert pool.choose(late) == 0  # has waited for LOOK others
        busy.task = None


@pytest.mark.parametrize("workers", [1, 3])
def test_rows_are_the_same(tmp_path, workers):
    def rows(name: str, groups: tuple[tuple[str, ...], ...]):
        fake = study(jitter=0.01)
        fake.mesh_groups = groups
        run = optimize(fake, out=tmp_path / name, workers=workers, cache=None)
        return [(record.number, record.grid, record.evaluation.objectives) for record in run.records]

    assert rows("in order", ()) == rows("chosen", (("a",), ("b",)))


def test_what_a_study_stretches_needs_no_mesh_of_its_own():
    assert codesign.load_study("ironcub_paper").mesh_groups == (("angle",), ("offset",))
    assert codesign.load_study("gimbal_quad").mesh_groups == ()
