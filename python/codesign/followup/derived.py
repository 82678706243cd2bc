"""Studies made from a study: to the optimizer they are studies like any other."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from codesign.errors import DesignError
from codesign.execution.affinity import Groups
from codesign.execution.pool import StudyRef
from codesign.execution.worker import load
from codesign.problem.design_space import DesignSpace, DesignValue
from codesign.problem.evaluation import Evaluation
from codesign.problem.identity import Identity
from codesign.problem.protocols import ExecutionDefaults, OptimizerDefaults, PartCache, Problem


@dataclass(frozen=True)
class DerivedStudy:
    """A study with something changed: `changes` (JSON values) says what, `loader` how to load it again."""

    study: Problem

    @property
    def changes(self) -> dict[str, Any]:
        """What was changed."""
        return {}

    @property
    def name(self) -> str:
        """The study's: both share one cache file, as their parts are the same."""
        return self.study.name

    @property
    def source(self) -> str:
        """All that is needed to make it again, as JSON."""
        ref = StudyRef.of(self.study)
        return json.dumps({"source": ref.source, "loader": ref.loader, "changes": self.changes})

    @property
    def hash(self) -> str:
        """Of the study and of what was changed."""
        return self.identity.hash

    @property
    def identity(self) -> Identity:
        """The study's, and what was changed."""
        of = self.study.identity
        return Identity({**of.sources, "variant": json.dumps(self.changes, sort_keys=True)}, of.libraries)

    @property
    def space(self) -> DesignSpace:
        """As the study's."""
        return self.study.space

    @property
    def mesh_groups(self) -> Groups:
        """As the study's."""
        return StudyRef.of(self.study).groups

    @property
    def objectives(self) -> tuple[str, ...]:
        """As the study's."""
        return self.study.objectives

    @property
    def optimizer(self) -> OptimizerDefaults:
        """As the study's."""
        return self.study.optimizer

    @property
    def execution(self) -> ExecutionDefaults:
        """As the study's."""
        return self.study.execution

    def evaluate(
        self, design: Mapping[str, DesignValue], /, trajectory: str | None = None, cache: PartCache | None = None
    ) -> Evaluation:
        """As the study's."""
        return self.study.evaluate(design, trajectory=trajectory, cache=cache)


@dataclass(frozen=True)
class CoarseStudy(DerivedStudy):
    """A study on part of its grid: every `strides[i]`-th value of variable i."""

    strides: tuple[int, ...]
    loader: str = "codesign.followup.derived:load_coarse"

    @property
    def changes(self) -> dict[str, Any]:
        """The strides."""
        return {"strides": self.strides}

    @property
    def space(self) -> DesignSpace:
        """The coarser grid."""
        variables = zip(self.study.space.variables, self.strides, strict=True)
        return DesignSpace(tuple(variable.every(stride) for variable, stride in variables))


def coarse(study: Problem, counts: Sequence[int]) -> CoarseStudy:
    """The study on the sub-grid with `counts[i]` values of variable i, evenly spaced, first and last included.

    Raises: DesignError if a variable cannot have that many; the message names those possible.
    """
    strides = []
    for variable, count in zip(study.space.variables, counts, strict=True):
        steps = variable.levels - 1
        possible = [steps // k + 1 for k in range(steps, 0, -1) if steps % k == 0] or [1]
        if count not in possible:
            raise DesignError(f"{variable.name}: {count} evenly spaced values are not possible, but {possible} are")
        strides.append(steps // (count - 1) if steps else 1)
    return CoarseStudy(study, tuple(strides))


def load_coarse(source: str) -> CoarseStudy:
    """Inverse of `CoarseStudy.source`."""
    study, changes = load_changes(source)
    return CoarseStudy(study, tuple(changes["strides"]))


def load_changes(source: str) -> tuple[Problem, dict[str, Any]]:
    """The study under a derived one, and what was changed."""
    document = json.loads(source)
    return load(document["loader"], document["source"]), document["changes"]
