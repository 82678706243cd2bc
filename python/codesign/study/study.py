"""A study as data: checked configuration, design space, base robot and part classes."""

from __future__ import annotations

import functools
import json
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from codesign.parts.part import Part
from codesign.problem.design_space import Design, DesignSpace, DesignValue
from codesign.problem.identity import Identity
from codesign.robot.description import RobotDescription
from codesign.study.choices import settings_of
from codesign.study.config import RawStudy, StudyConfig
from codesign.study.conversion import convert, replace_value
from codesign.study.fingerprint import part_identity


@dataclass(frozen=True, repr=False)
class StudyData:
    """Everything that defines a study. Immutable; `codesign.study.loading.load` makes and checks it.

    source: the name or path it was loaded from (worker processes load it again from there).
    functions: own functions of an evaluation, `module:function`.
    raw: the parsed TOML, units in its keys, on which design variables with `sets` act. identity: what decides a result.
    """

    source: str
    path: Path
    raw: RawStudy
    config: StudyConfig
    space: DesignSpace
    part_classes: dict[str, type[Part]]
    functions: dict[str, Callable[[Mapping[str, Any]], float]]
    base_robot: RobotDescription
    identity: Identity

    def __repr__(self) -> str:
        objectives = ", ".join(self.objectives)
        designs = math.prod(self.space.levels)
        return f"<{type(self).__name__} {self.name!r}: {designs:,} designs, minimizes {objectives}>"

    @functools.cached_property
    def hash(self) -> str:
        """Of all that decides a result."""
        return self.identity.hash

    @functools.cached_property
    def code_hash(self) -> str:
        """Of what decides the numbers of a part besides its own values and settings: its code, engine, libraries."""
        return part_identity(self.identity).hash

    @property
    def name(self) -> str:
        """Short name."""
        return self.config.name

    @property
    def title(self) -> str:
        """One line for people."""
        return self.config.title or self.config.name

    @property
    def description(self) -> str:
        """A paragraph for people."""
        return self.config.description

    @property
    def objectives(self) -> tuple[str, ...]:
        """Keys of the minimized numbers; a maximized one has a minus before its name."""
        return self.config.objectives.keys

    @property
    def optimizer(self) -> Any:
        """Defaults of the search."""
        return self.config.optimizer

    @property
    def execution(self) -> Any:
        """Workers and limits."""
        return self.config.execution

    @property
    def baseline(self) -> Design | None:
        """The design that reports compare with, if the study names one."""
        return self.space.design(self.config.baseline) if self.config.baseline else None

    @property
    def trajectories(self) -> tuple[str, ...]:
        """Names of the trajectories."""
        return tuple(self.config.trajectories)

    def configured(self, design: Mapping[str, DesignValue]) -> StudyConfig:
        """The configuration with what the design variables set replaced."""
        replaced = list(settings_of(self.config, design))
        if not replaced:
            return self.config
        raw = json.loads(json.dumps(self.raw))
        for place, value in replaced:
            replace_value(raw, place, value, self.path)
        return convert(raw, self.path)
