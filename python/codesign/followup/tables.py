"""Tables of parts: every part over the whole grid of the variables that decide it, analyzed once for all designs."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Unpack

from codesign.chain.study import Study
from codesign.chain.tables import MASS, analyze_alone, deciding_variables, flies_for_strength, start_design
from codesign.errors import StudyError
from codesign.followup.derived import DerivedStudy, load_changes
from codesign.names import nearest
from codesign.problem.design_space import Design, DesignSpace, DesignValue
from codesign.problem.evaluation import Evaluation
from codesign.problem.protocols import PartCache
from codesign.search.optimization import Resources, resume, sweep
from codesign.storage.database import DATABASE
from codesign.storage.runs import Run

MOST_DESIGNS = 20_000  # of a table, unless told otherwise


@dataclass(frozen=True)
class PartStudy(DerivedStudy):
    """One part of a study over the variables that decide it; the others keep the values of the start design."""

    study: Study
    part: str
    variables: tuple[str, ...]
    loader: str = "codesign.followup.tables:load_part"

    @property
    def changes(self) -> dict[str, Any]:
        """The part and its variables."""
        return {"part": self.part, "variables": self.variables}

    @property
    def space(self) -> DesignSpace:
        """The grid of the part's variables."""
        return DesignSpace(tuple(v for v in self.study.space.variables if v.name in self.variables))

    @property
    def objectives(self) -> tuple[str, ...]:
        """The mass; a table has no front."""
        return (MASS,)

    def evaluate(
        self, design: Mapping[str, DesignValue], /, trajectory: str | None = None, cache: PartCache | None = None
    ) -> Evaluation:
        """The part of one design; nothing flies."""
        del trajectory
        whole: Design = self.study.space.design({**start_design(self.study), **design})
        return dataclasses.replace(analyze_alone(self.study, whole, self.part, cache), design=dict(design))


def load_part(source: str) -> PartStudy:
    """Inverse of `PartStudy.source`."""
    study, changes = load_changes(source)
    assert isinstance(study, Study)  # only these are tabulated
    return PartStudy(study, changes["part"], tuple(changes["variables"]))


@dataclass(frozen=True)
class Table:
    """What was done for one part. run: of its designs; None where there is nothing to tabulate, `reason` says why."""

    part: str
    variables: tuple[str, ...]
    run: Run | None
    reason: str | None = None


def tabulate(
    study: Study,
    parts: Sequence[str] = (),
    *,
    out: str | Path,
    most: int = MOST_DESIGNS,
    **resources: Unpack[Resources],
) -> list[Table]:
    """Analyzes parts over the whole grid of their variables, into the cache that evaluations of the study read.

    Args:
        study: a loaded study. parts: names; all parts if there are none.
        out: folder; a run of every part is kept in it and continued where it was stopped.
        most: designs of a part, beyond which it is refused.
        resources: see Resources.
    Raises: StudyError: there is no such part, or its grid is too large; StoreError, ExecutionError as `optimize`.
    """
    names = [part.name for part in study.config.parts]
    for name in parts:
        if name not in names:
            raise StudyError(f"{study.path}: there is no part {name!r}; {nearest(name, names)}")
    wanted = {name: deciding_variables(study, name) for name in parts or names}
    for name, variables in wanted.items():
        count = math.prod(study.space.levels[i] for i, n in enumerate(study.space.names) if n in variables)
        if count > most:
            raise StudyError(
                f"{study.path}: part {name} has {count:,} designs ({', '.join(variables)}); at most {most:,}"
            )
    return [_table(study, name, variables, Path(out) / name, resources) for name, variables in wanted.items()]


def _table(study: Study, name: str, variables: tuple[str, ...], out: Path, resources: Resources) -> Table:
    if not variables:
        return Table(name, variables, None, "not tabulated: it is the same in every design")
    if flies_for_strength(study, name):
        return Table(name, variables, None, "not tabulated: its strength depends on the flight of every design")
    if (out / DATABASE).exists():
        return Table(name, variables, resume(out, **resources))
    problem = PartStudy(study, name, variables)
    return Table(name, variables, sweep(problem, problem.space.levels, out=out, **resources))
