"""What designs are worth before they are evaluated: expected gain over the front times the chance of being feasible."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from codesign.problem.pareto import non_dominated
from codesign.search.base import Grid
from codesign.surrogate.boxes import MOST_OBJECTIVES
from codesign.surrogate.improvement import ChebyshevImprovement, HypervolumeImprovement, Improvement
from codesign.surrogate.models import DesignModels

Array = npt.NDArray[np.float64]

LEAST_DEVIATION = 1e-9  # of a prediction, in scaled objectives
PART = 2000  # designs scored at a time
FEW = 10  # front designs below which the reference point is not better than the median design
MARGIN = 0.1  # of the front's range: how far the reference point lies beyond its worst values
LEAST_RANGE = 0.1  # of the way from the median design to the best value
MEDIAN = 0.0  # in scaled objectives


@dataclass(frozen=True, slots=True)
class Prospects:
    """Models of the designs and the front that is to be beaten.

    front: (n, varying objectives) scaled objectives of the feasible designs that no other dominates. varying: numbers
    of the objectives that are not the same for all designs. worst: (varying,) worst values of the feasible designs.
    """

    models: DesignModels
    front: Array
    varying: tuple[int, ...]
    worst: Array

    @classmethod
    def of(cls, models: DesignModels, feasible: Array) -> Prospects:
        """Those of models and of (n, objectives) values of the feasible designs."""
        varying = tuple(j for j, output in enumerate(models.objectives) if output.process is not None)
        columns = [models.scalings[j].forward(feasible[:, j]) for j in varying]
        scaled = np.stack(columns, axis=1) if varying else np.empty((len(feasible), 0))
        worst = scaled.max(axis=0, initial=-np.inf)
        return cls(models, scaled[non_dominated(scaled)], varying, worst)

    def with_design(self, grid: Grid) -> Prospects:
        """As if a design had given just what is predicted."""
        front = self.front
        if self.varying:
            mean, _ = self.models.predict(self.models.coordinates.of([grid]))
            both = np.vstack([front, mean[:, self.varying]])
            front = both[non_dominated(both)]
        return replace(self, models=self.models.conditioned(grid), front=front)

    def improvement(self, wide: bool, rng: np.random.Generator) -> Improvement | None:
        """The expected gain that designs are ranked by; None: by the chance of being feasible alone.

        wide: beyond the front's ends, too, as far as feasible designs are known.
        """
        if not self.varying or not len(self.front):
            return None
        if len(self.varying) > MOST_OBJECTIVES:
            return ChebyshevImprovement(self.front, rng.dirichlet(np.ones(len(self.varying))), rng)
        return HypervolumeImprovement(self.front, reference_point(self.front, self.worst if wide else None))

    def worth(self, grids: Sequence[Grid], improvement: Improvement | None) -> Array:
        """(n,) worth of grid points."""
        parts: list[Array] = [self._worth(grids[i : i + PART], improvement) for i in range(0, len(grids), PART)]
        return np.concatenate(parts)

    def _worth(self, grids: Sequence[Grid], improvement: Improvement | None) -> Array:
        inputs = self.models.coordinates.of(grids)
        chance = self.models.feasibility(inputs)
        if improvement is None:
            return chance
        mean, deviation = self.models.predict(inputs)
        gain = improvement.of(mean[:, self.varying], np.maximum(deviation[:, self.varying], LEAST_DEVIATION))
        worth: Array = chance * gain
        return worth


def reference_point(front: Array, worst: Array | None = None) -> Array:
    """(objectives,) where gains end: a little beyond the front's worst values.

    Not better than `worst` (objectives,) if given, and than the median design while the front has few designs.
    """
    nadir = front.max(axis=0)
    reference: Array = nadir + MARGIN * np.maximum(nadir - front.min(axis=0), LEAST_RANGE)
    if worst is not None:
        reference = np.maximum(reference, worst)
    if len(front) < FEW:
        reference = np.maximum(reference, MEDIAN)
    return reference
