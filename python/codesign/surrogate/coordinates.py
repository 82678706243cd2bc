"""Where the points of the design grid lie for a model: numbers in the unit box, named choices equally far apart."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from codesign.problem.design_space import DesignSpace

Array = npt.NDArray[np.float64]


class Coordinates:
    """Grid points as rows of numbers whose Euclidean distance is a distance of designs.

    A variable that takes numbers has one column, the center of its cell (index + 1/2) / levels, so a step of the grid
    means the same for every variable. A named choice has a column for each name, of which one is 1/sqrt(2) and
    the others 0: any two names are one apart. `variable`: (columns,) number of the variable that a column belongs to.
    """

    def __init__(self, space: DesignSpace) -> None:
        self._levels = space.levels
        self._named = tuple(variable.named for variable in space.variables)
        widths = [levels if named else 1 for levels, named in zip(self._levels, self._named, strict=True)]
        self.variables = len(widths)
        self.variable: npt.NDArray[np.int_] = np.repeat(np.arange(self.variables), widths)

    def of(self, grids: Sequence[Sequence[int]] | npt.NDArray[np.int_]) -> Array:
        """(n, columns) coordinates of n grid points."""
        points = np.asarray(grids, dtype=int).reshape(-1, self.variables)
        columns = []
        for levels, named, indices in zip(self._levels, self._named, points.T, strict=True):
            if named:
                columns += [np.where(indices == name, np.sqrt(0.5), 0.0) for name in range(levels)]
            else:
                columns.append((indices + 0.5) / levels)
        return np.column_stack(columns)
