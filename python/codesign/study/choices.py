"""What the design variables of a study stand for: grid, parameters of parts, places of the study that they set."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from codesign.problem.design_space import DesignSpace, DesignValue, Variable
from codesign.study.config import StudyConfig, VariableConfig


def design_space(config: StudyConfig) -> DesignSpace:
    """The design variables on their integer grid."""
    return DesignSpace(tuple(_variable(name, variable) for name, variable in config.variables.items()))


def _variable(name: str, variable: VariableConfig) -> Variable:
    if variable.minimum is None or variable.maximum is None or variable.step is None:
        return Variable.listed(name, variable.listed, "" if variable.choices else variable.unit)
    return Variable(name, variable.minimum, variable.maximum, variable.step, variable.unit)


def numbers_of(config: StudyConfig, design: Mapping[str, DesignValue]) -> dict[str, float]:
    """What parameters of parts may take: numbers of the design, and `variable.key` of its choices."""
    found = {name: value for name, value in design.items() if not isinstance(value, str)}
    for name, variable in config.variables.items():
        if isinstance(variable.choices, dict):
            chosen = variable.choices[str(design[name])]
            found |= {f"{name}.{key}": float(value) for key, value in chosen.items() if is_number(value)}
    return found


def settings_of(config: StudyConfig, design: Mapping[str, DesignValue]) -> Iterator[tuple[str, float | bool | str]]:
    """Places of the study, as dotted paths, with the values that a design sets there."""
    for name, variable in config.variables.items():
        for place in variable.sets:
            yield place, design[name]
        if isinstance(variable.choices, dict):
            for key, value in variable.choices[str(design[name])].items():
                if "." in key:
                    yield key, value


def places_set(config: StudyConfig) -> set[str]:
    """Every place of the study that some design sets, as a dotted path."""
    return {
        place
        for variable in config.variables.values()
        for place in (*variable.sets, *variable.chosen_keys)
        if "." in place
    }


def is_number(value: float | bool | str) -> bool:
    """Whether a choice's value is a number."""
    return isinstance(value, int | float) and not isinstance(value, bool)
