"""A study that can be evaluated: its data and the chain in one object."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from codesign.chain import chain, confirmed, lazy
from codesign.chain.controllability import Controllability, grounded, study_controllability
from codesign.errors import CodesignError
from codesign.parts.part import Part
from codesign.problem.design_space import DesignValue
from codesign.study.loading import load
from codesign.study.parts import mesh_groups
from codesign.study.study import StudyData

if TYPE_CHECKING:
    from codesign.parts.strength import Confirmation
    from codesign.problem.evaluation import Evaluation
    from codesign.problem.protocols import PartCache, Rival


@dataclass(frozen=True, repr=False)
class Study(StudyData):
    """What a study defines, and the chain that evaluates its designs."""

    def build_parts(self, theta: Mapping[str, DesignValue] | Sequence[DesignValue]) -> dict[str, Part]:
        """Parts of a design by name."""
        return chain.build_parts(self, self.space.design(theta))

    def build_robot(self, theta: Mapping[str, DesignValue] | Sequence[DesignValue]) -> str:
        """URDF text of the robot with this design's parts."""
        return chain.build_robot(self, self.space.design(theta)).to_text()

    def evaluate(
        self,
        theta: Mapping[str, DesignValue] | Sequence[DesignValue],
        trajectory: str | None = None,
        cache: PartCache | None = None,
    ) -> Evaluation:
        """One design through the whole chain; `trajectory`: a name of the study, default its own.

        With `chain.confirmed.CONFIRMED` in its place nothing flies: parts alone, in full on fine meshes.
        """
        if trajectory == confirmed.CONFIRMED:
            return confirmed.evaluate_confirmed(self, self.space.design(theta), cache)
        return chain.evaluate(self, self.space.design(theta), trajectory=trajectory, cache=cache)

    @functools.cached_property
    def mesh_groups(self) -> tuple[tuple[str, ...], ...]:
        """For each part that is stretched from others the variables that decide from which; see `Part.stretched_from`.

        Empty if the parts of the grid's first or middle design cannot be made.
        """
        first, middle = [0] * len(self.space.levels), [levels // 2 for levels in self.space.levels]
        try:
            return mesh_groups(self.config, [self.build_parts(self.space.from_indices(i)) for i in (first, middle)])
        except CodesignError:
            return ()

    def controllability(self, theta: Mapping[str, DesignValue] | Sequence[DesignValue]) -> Controllability:
        """What thrusts and joints can do for the robot with a design's parts, at the start posture."""
        return study_controllability(self, self.space.design(theta))

    @property
    def grounded(self) -> str | None:
        """Why no design can fly, told before the search; None if nothing speaks against it."""
        return grounded(self)

    def evaluate_lazily(
        self,
        theta: Mapping[str, DesignValue] | Sequence[DesignValue],
        rivals: Sequence[Rival],
        /,
        cache: PartCache | None = None,
    ) -> Evaluation:
        """As `evaluate`, without strength and clearances of a design that cannot enter the front; see `chain.lazy`."""
        return lazy.evaluate_lazily(self, self.space.design(theta), rivals, cache)

    def confirm(self, theta: Mapping[str, DesignValue] | Sequence[DesignValue]) -> dict[str, Confirmation]:
        """Parts of a design by name, as analyzed and with full geometry on a fine mesh (some seconds per part)."""
        return chain.confirm_parts(self, self.space.design(theta))


def load_study(source: str | Path = "ironcub") -> Study:
    """Loads and checks a study.

    Args:
        source: a shipped study's name, or the path of a study.toml or of its folder.
    Raises: StudyError with file, key and reason.
    """
    study: Study = load(source, Study)
    return study
