"""What the optimizer needs of a study: any object with these members can be optimized, wherever it comes from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Protocol, runtime_checkable

from codesign.problem.design_space import DesignSpace, DesignValue
from codesign.problem.evaluation import Evaluation
from codesign.problem.identity import Identity

Rival = tuple[int, Sequence[float]]  # number and objectives of a feasible design


class PartCache(Protocol):
    """What an evaluation needs of a cache; keys contain the hash of everything that decides the value."""

    def get(self, key: str) -> dict[str, Any] | None:
        """The stored value, or None."""

    def put(self, key: str, value: dict[str, Any]) -> None:
        """Stores a JSON-compatible value."""


class OptimizerDefaults(Protocol):
    """A study's [optimizer]."""

    @property
    def algorithm(self) -> str:
        """Name of the search."""

    @property
    def seed(self) -> int:
        """Decides everything that is random."""

    @property
    def population(self) -> int:
        """Designs of a generation."""

    @property
    def generations(self) -> int:
        """Generations, the start population included."""

    @property
    def evaluations(self) -> int | None:
        """The budget; None: the search's own, else population times generations."""

    @property
    def crossover_probability(self) -> float:
        """That two parents are crossed."""

    @property
    def mutation_probability(self) -> float:
        """Of each variable of a child."""


class ExecutionDefaults(Protocol):
    """A study's [execution]; a limit of 0 means none."""

    @property
    def workers(self) -> int:
        """Worker processes."""

    @property
    def lazy(self) -> bool | str | None:
        """Whether strength and clearances of designs that cannot enter the front are left out; None: the search's."""

    @property
    def time_limit_s(self) -> float:
        """Wall time of one evaluation [s]."""

    @property
    def memory_limit_mib(self) -> int:
        """Memory of one evaluation [MiB], beyond what the loaded study takes."""


class Problem(Protocol):
    """A study as the optimizer sees it.

    Worker processes load it again: by `codesign.load_study(source)`, or by another `module:function` named in an
    attribute `loader`.
    """

    @property
    def name(self) -> str:
        """For people, and for the name of the cache file."""

    @property
    def source(self) -> str:
        """What a worker process loads it from."""

    @property
    def hash(self) -> str:
        """Of everything that decides a result."""

    @property
    def identity(self) -> Identity:
        """Everything that decides a result, by name."""

    @property
    def space(self) -> DesignSpace:
        """The design grid."""

    @property
    def objectives(self) -> tuple[str, ...]:
        """Keys of Evaluation.objectives to minimize."""

    @property
    def optimizer(self) -> OptimizerDefaults:
        """Defaults of a search."""

    @property
    def execution(self) -> ExecutionDefaults:
        """Defaults of how evaluations run."""

    def evaluate(
        self, design: Mapping[str, DesignValue], /, trajectory: str | None = None, cache: PartCache | None = None
    ) -> Evaluation:
        """One design, on the study's own trajectory unless another is named."""


@runtime_checkable
class LazyProblem(Problem, Protocol):
    """A problem that can tell early that a design will not enter the front."""

    def evaluate_lazily(
        self, design: Mapping[str, DesignValue], rivals: Sequence[Rival], /, cache: PartCache | None = None
    ) -> Evaluation:
        """One design; `skipped` as soon as one of the rivals is nowhere worse."""
