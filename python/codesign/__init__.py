"""codesign: parametric parts, robot, controller and task in; the best buildable designs out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from codesign.chain.study import Study, load_study
    from codesign.problem.design_space import DesignValue
    from codesign.problem.evaluation import Evaluation
    from codesign.search.optimization import optimize, resume

__version__ = "0.1.0"
__all__ = ["Evaluation", "Study", "evaluate", "load_study", "optimize", "resume"]

# Imported when first used: a worker process needs no optimizer, a look at the version needs nothing.
_HOMES = {
    "Evaluation": "codesign.problem.evaluation",
    "Study": "codesign.chain.study",
    "load_study": "codesign.chain.study",
    "optimize": "codesign.search.optimization",
    "resume": "codesign.search.optimization",
}


def evaluate(theta: Mapping[str, DesignValue] | Sequence[DesignValue]) -> Evaluation:
    """One design of the default study through the whole chain; theta by names or in variable order, study units."""
    from codesign.chain.study import load_study

    return load_study().evaluate(theta)


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'codesign' has no attribute {name!r}")
    import importlib

    return getattr(importlib.import_module(_HOMES[name]), name)
