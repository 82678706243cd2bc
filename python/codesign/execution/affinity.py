"""Which of the waiting evaluations a worker takes: one that needs meshes which it has kept, or which nobody has.

Where evaluations run decides nothing about their results, see `cpp/fem/kept_meshes.hpp`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from codesign.problem.design_space import DesignValue

Groups = tuple[tuple[str, ...], ...]  # variables whose values name a mesh, for each part
Key = tuple[int, tuple[DesignValue, ...]]  # number of the group, values
LOOK = 64  # evaluations that may be done before one that has waited longer


def keys_of(design: Mapping[str, DesignValue], groups: Groups) -> frozenset[Key]:
    """What an evaluation of a design needs and leaves in its worker."""
    return frozenset((k, tuple(design[name] for name in names)) for k, names in enumerate(groups))


def waste(needed: frozenset[Key], kept: set[Key], elsewhere: set[Key]) -> tuple[int, int]:
    """How bad a choice an evaluation is for a worker that has kept some, when others have kept what is `elsewhere`.

    First by what would be made twice; then what is new to all goes first: it takes longest, and others wait for it.
    """
    missing = needed - kept
    return len(missing & elsewhere), -len(missing - elsewhere)


def best(needed: Sequence[frozenset[Key]], kept: Sequence[set[Key]], free: Sequence[int]) -> tuple[int, int]:
    """Numbers of the evaluation and of the free worker that fit best; of equal ones the first.

    needed: of each evaluation. kept: by each worker. free: numbers of the workers that have nothing to do.
    """
    elsewhere = {w: set().union(*(other for k, other in enumerate(kept) if k != w)) for w in free}
    choices = ((waste(keys, kept[w], elsewhere[w]), k, w) for k, keys in enumerate(needed) for w in free)
    _, evaluation, worker = min(choices)
    return evaluation, worker
