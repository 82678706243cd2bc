"""Which design variables decide what is meshed: designs that agree in them share meshes and factors in a process."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from codesign.parts.part import Part
    from codesign.study.config import StudyConfig


def mesh_groups(config: StudyConfig, made: Sequence[Mapping[str, Part]]) -> tuple[tuple[str, ...], ...]:
    """For each part that is stretched from others the variables that decide from which; see `Part.stretched_from`.

    made: parts of some designs by name. A parameter in which one of them differs from what it is stretched from is the
    length that is stretched.
    """
    groups = []
    for part in config.parts:
        lengths: set[str] = set()
        for parts in made:
            own, found = parts[part.name], parts[part.name].stretched_from()
            if found is not None:
                lengths |= {name for name, value in own.parameters.items() if found[0].parameters[name] != value}
        others = [variable for parameter, variable in part.parameters.items() if parameter not in lengths]
        if lengths and others:
            groups.append(tuple(dict.fromkeys(variable.partition(".")[0] for variable in others)))
    return tuple(groups)
