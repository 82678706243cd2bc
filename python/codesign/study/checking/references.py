"""What is wrong with a study beyond the types of its values: bounds, cross-references, names.

Every check yields pairs (key, reason); a loader raises the first, `codesign check` shows all.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from codesign.names import nearest
from codesign.parts.materials import material_names
from codesign.parts.part import Part, parameter_units
from codesign.study.checking.numbers import number_problems
from codesign.study.checking.problems import Problem, repeated, unknown
from codesign.study.choices import is_number
from codesign.study.config import PartConfig, StudyConfig, VariableConfig

MOST_LEVELS = 1_000_000  # grid values of a variable


def reference_problems(config: StudyConfig, part_classes: Mapping[str, type[Part]]) -> Iterator[Problem]:
    """Everything outside of [flight] that can be judged from the file and the part classes alone."""
    if not config.parts:
        yield "parts", "a study needs at least one part"
    yield from _variable_problems(config)
    if twice := repeated(part.name for part in config.parts):
        yield "parts", f"two parts have the name {twice!r}"
    for part in config.parts:
        yield from _part_problems(part, config, part_classes[part.name])
    yield from number_problems(config)
    yield from _clearance_problems(config)


def _variable_problems(config: StudyConfig) -> Iterator[Problem]:
    if not config.variables:
        yield "variables", "a study needs at least one design variable"
    changes = config.robot.changes if config.robot is not None else []
    used = {name for part in config.parts for name in part.parameters.values()} | {c.variable for c in changes}
    for index, change in enumerate(changes):
        key = f"robot.changes[{index}].variable"
        offered = _offered_numbers(config)
        yield from unknown(key, "design variable", change.variable, offered)
        if offered.get(change.variable, "mm") != "mm":
            yield key, f"{change.variable!r} must have the unit mm"
    for name, variable in config.variables.items():
        key = f"variables.{name}"
        if not name or "=" in name or "." in name or name != name.strip():
            yield key, f"{name!r} cannot be given as --set NAME=VALUE"
        yield from _grid_problems(key, variable)
        yield from _choice_problems(key, variable)
        takes = {name, *(f"{name}.{chosen}" for chosen in variable.chosen_keys)}
        if used.isdisjoint(takes) and not variable.sets and not any("." in chosen for chosen in variable.chosen_keys):
            yield key, "no part takes it and it sets nothing"
    if config.baseline:
        for name in config.baseline:
            yield from unknown(f"baseline.{name}", "design variable", name, config.variables)
        for name in config.variables:
            if name not in config.baseline:
                yield "baseline", f"no value for design variable {name!r}"


def _grid_problems(key: str, variable: VariableConfig) -> Iterator[Problem]:
    if variable.minimum is None or variable.maximum is None or variable.step is None:
        return
    span = variable.maximum - variable.minimum
    if span <= 0.0:
        yield key, f"max = {variable.maximum:g} must be above min = {variable.minimum:g}"
    elif span / variable.step >= MOST_LEVELS:
        yield f"{key}.step", f"{variable.step:g} gives more than {MOST_LEVELS} values from min to max"
    elif abs(span / variable.step - round(span / variable.step)) > 1e-6:
        yield f"{key}.step", f"{variable.step:g} does not divide max - min into whole steps"


def _choice_problems(key: str, variable: VariableConfig) -> Iterator[Problem]:
    listed = "values" if variable.values else "choices"
    if variable.listed:
        if len(variable.listed) < 2:
            yield f"{key}.{listed}", f"{variable.listed[0]!r} alone is no choice: list at least two"
        if len(set(variable.listed)) < len(variable.listed):
            yield f"{key}.{listed}", f"{repeated(map(str, variable.listed))} is listed twice"
    if variable.values and variable.values != sorted(variable.values):
        yield f"{key}.values", "must ascend: the search takes neighbors in the list for similar"
    if variable.choices and variable.unit and not isinstance(variable.choices, dict):
        yield f"{key}.unit", "names have no unit"
    if isinstance(variable.choices, dict):
        keys = set(variable.chosen_keys)
        for name, chosen in variable.choices.items():
            if set(chosen) != keys:
                odd = ", ".join(sorted(keys ^ set(chosen)))
                yield f"{key}.choices.{name}", f"all choices must set the same keys; not so: {odd}"
            for inner, value in chosen.items():
                if "." not in inner and not is_number(value):
                    yield f"{key}.choices.{name}.{inner}", f"{value!r} is not a number, which a part could take"


def _part_problems(part: PartConfig, config: StudyConfig, part_class: type[Part]) -> Iterator[Problem]:
    key = f"parts.{part.name}"
    if part.material not in config.materials:
        near = nearest(part.material, dict.fromkeys([*config.materials, *material_names()]))
        yield f"{key}.material", f"{part.material!r} is neither in [materials] nor a known material; {near}"
    units = parameter_units(part_class)
    for parameter in part.parameters:
        yield from unknown(f"{key}.parameters", f"parameter of {part.shape}", parameter, units)
    for parameter in units:
        if parameter not in part.parameters and parameter not in part.options:
            yield f"{key}.parameters", f"{part.shape} takes {parameter!r} too, which is not given"
    offered = _offered_numbers(config)
    for parameter, name in part.parameters.items():
        place = f"{key}.parameters.{parameter}"
        if name in config.variables and name not in offered:
            inner = ", ".join(f"{name}.{chosen}" for chosen in config.variables[name].chosen_keys)
            yield place, f"{name!r} is a choice of names" + (f"; there are {inner}" if inner else ", not a number")
            continue
        yield from unknown(place, "design variable", name, offered)
        if name in offered and parameter in units and offered[name] != units[parameter]:
            yield f"variables.{name}.unit", f"{part.shape} expects {units[parameter]!r} for {parameter}"
    if not part.supports:
        yield f"{key}.supports", "empty: nothing would hold the part; name the faces that are clamped"
    yield from _load_problems(part, key)


def _load_problems(part: PartConfig, key: str) -> Iterator[Problem]:
    if part.loads and part.cases:
        yield f"{key}.loads", "either loads (one load case) or cases (by name)"
    if part.cases and all(case.flown for case in part.cases):
        yield (
            f"{key}.cases",
            "all are flown: one case with loads of its own is needed, for lost flights and for the mesh",
        )
    if twice := repeated(case.name for case in part.cases):
        yield f"{key}.cases", f"two load cases have the name {twice!r}"
    for case in part.load_cases:
        if "." in case.name:
            yield f"{key}.cases", f"a load case's name must not hold a dot: {case.name!r}"
        if case.flown and case.loads:
            yield f"{key}.cases[{case.name}]", "either loads or flown: a flight adds its own weight and inertia"
        if not case.loads and not case.flown:
            yield (
                f"{key}.cases[{case.name}].loads" if part.cases else f"{key}.loads",
                "empty: nothing would load the part",
            )


def _offered_numbers(config: StudyConfig) -> dict[str, str]:
    """Numbers that parameters of parts may take, with their units."""
    offered: dict[str, str] = {name: v.unit for name, v in config.variables.items() if not v.choices}
    for name, v in config.variables.items():
        offered |= {f"{name}.{key}": v.unit for key in v.chosen_keys if "." not in key}
    return offered


def _clearance_problems(config: StudyConfig) -> Iterator[Problem]:
    """Clearances that are demanded must be measured, and so far that the demand can be met."""
    measured = config.interference
    for name in ("body_clearance_min_mm", "plume_clearance_min_mm"):
        least = getattr(config.constraints, name)
        if least is None:
            continue
        if measured is None:
            yield f"constraints.{name}", "needs the section [interference], which says what is measured"
        elif name.startswith("plume") and not measured.plumes.jets:
            yield f"constraints.{name}", "needs jets in [interference.plumes]"
        elif least > measured.report_below_mm:
            farthest = f"interference.report_below_mm = {measured.report_below_mm:g}"
            yield f"constraints.{name}", f"{least:g} is above {farthest}: gaps beyond are not measured"
