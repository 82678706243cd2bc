"""Whole evaluations in the cache: a design that any run or command has evaluated is not evaluated again."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence

from codesign.problem.design_space import DesignValue
from codesign.problem.evaluation import Evaluation
from codesign.problem.protocols import PartCache, Problem


def design_key(study: Problem, grid: Sequence[int], trajectory: str = "") -> str:
    """Cache key of an evaluation; trajectory "": the study's own."""
    text = json.dumps([study.hash, list(grid), *([trajectory] if trajectory else [])])
    return "design " + hashlib.sha256(text.encode()).hexdigest()


def known_evaluation(
    study: Problem, grid: Sequence[int], cache: PartCache | None, trajectory: str = ""
) -> Evaluation | None:
    """The evaluation in the cache, if there is one."""
    document = cache.get(design_key(study, grid, trajectory)) if cache is not None else None
    return None if document is None else Evaluation.from_dict(document)


def keep_evaluation(
    study: Problem, grid: Sequence[int], evaluation: Evaluation, cache: PartCache | None, trajectory: str = ""
) -> None:
    """Puts an evaluation into the cache; failed ones are not kept, they may succeed another time."""
    if cache is not None and evaluation.status != "failed":
        cache.put(design_key(study, grid, trajectory), evaluation.to_dict())


def evaluate_once(
    study: Problem, theta: Mapping[str, DesignValue], cache: PartCache | None, trajectory: str | None = None
) -> tuple[Evaluation, bool]:
    """The evaluation of a design, from the cache or else computed and kept there; and whether it was known.

    Raises: DesignError, StudyError.
    """
    grid, flown = study.space.indices(theta), trajectory or ""
    known = known_evaluation(study, grid, cache, flown)
    if known is not None:
        return known, True
    evaluation = study.evaluate(study.space.from_indices(grid).to_dict(), trajectory=trajectory, cache=cache)
    keep_evaluation(study, grid, evaluation, cache, flown)
    return evaluation, False
