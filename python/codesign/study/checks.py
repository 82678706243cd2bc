"""Cross-references and bounds of a study that types cannot express."""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from codesign.errors import StudyError
from codesign.parts.part import Part, parameter_units
from codesign.problem.quantities import QUANTITIES
from codesign.study.config import StudyConfig

MOST_OBJECTIVES = 6


def check_study(config: StudyConfig, part_classes: Mapping[str, type[Part]], path: Path) -> None:
    """Cross-references and bounds that types cannot express; raises StudyError with file, key and reason."""

    def refuse(key: str, reason: str) -> None:
        raise StudyError(f"{path}: {key}: {reason}")

    if not config.variables:
        refuse("variables", "a study needs at least one design variable")
    for name, variable in config.variables.items():
        if variable.maximum <= variable.minimum:
            refuse(f"variables.{name}", f"max = {variable.maximum:g} must be above min = {variable.minimum:g}")
        steps = (variable.maximum - variable.minimum) / variable.step
        if abs(steps - round(steps)) > 1e-6:
            refuse(f"variables.{name}.step", f"{variable.step:g} does not divide max - min into whole steps")
    names = [part.name for part in config.parts]
    if len(set(names)) != len(names):
        refuse("parts", f"two parts have the name {next(n for n in names if names.count(n) > 1)!r}")
    for part in config.parts:
        key = f"parts.{part.name}"
        if part.material not in config.materials:
            refuse(f"{key}.material", f"{part.material!r} is not in [materials]: {', '.join(config.materials)}")
        units = parameter_units(part_classes[part.name])
        if set(part.parameters) != set(units):
            refuse(f"{key}.parameters", f"{part.shape} takes {', '.join(units)}; given {', '.join(part.parameters)}")
        for parameter, name in part.parameters.items():
            if name not in config.variables:
                refuse(f"{key}.parameters.{parameter}", f"no design variable {name!r}")
            if config.variables[name].unit != units[parameter]:
                refuse(f"variables.{name}.unit", f"{part.shape} expects {units[parameter]!r} for {parameter}")
    used = {name for part in config.parts for name in part.parameters.values()}
    for name, variable in config.variables.items():
        if name not in used and not variable.sets:
            refuse(f"variables.{name}", "no part takes it and it sets nothing")
    _check_flight(config, refuse)
    _check_numbers(config, refuse)


def _check_flight(config: StudyConfig, refuse: Any) -> None:
    flight = config.flight
    for group in flight.joint_groups:
        for key in ("initial_rad", "ranges_deg"):
            if len(getattr(group, key)) != len(group.joints):
                refuse(f"flight.joint_groups[{group.name}].{key}", f"needs {len(group.joints)} entries, one a joint")
        for joint, (low, high) in zip(group.joints, group.ranges_deg, strict=True):
            if low >= high:
                refuse(f"flight.joint_groups[{group.name}].ranges_deg", f"{joint}: {low:g} must be below {high:g}")
    for pair in flight.jets.symmetric_pairs:
        for jet in pair:
            if jet not in flight.jets.frames:
                refuse("flight.jets.symmetric_pairs", f"no jet {jet!r}")
    for key, name in [("flight.trajectory", flight.trajectory)] + [
        ("validation.trajectories", name) for name in config.validation.trajectories
    ]:
        if name not in config.trajectories:
            refuse(key, f"no trajectory {name!r}; there are {', '.join(config.trajectories)}")
    for name, trajectory in config.trajectories.items():
        for window in trajectory.windows:
            if window.to_s <= window.from_s:
                refuse(f"trajectories.{name}.windows", f"to_s = {window.to_s:g} is not after {window.from_s:g}")
    if flight.jet_model == "turbine" and flight.turbine is None:
        refuse("flight.jet_model", "'turbine' needs [flight.turbine]")


def _check_numbers(config: StudyConfig, refuse: Any) -> None:
    """Names of objectives and limits, as far as they are known before an evaluation."""
    names = config.objectives.names
    if not 1 <= len(names) <= MOST_OBJECTIVES:
        refuse("objectives", f"{len(names)} objectives: there must be one to {MOST_OBJECTIVES}")
    if len(set(names)) != len(names):
        refuse("objectives", f"{next(n for n in names if names.count(n) > 1)!r} is named twice")
    for key, listed in (
        ("objectives.minimise", config.objectives.minimise),
        ("objectives.maximise", config.objectives.maximise),
        ("constraints.limits", tuple(config.constraints.limits)),
    ):
        for name in listed:
            if reason := _unknown_number(config, name):
                refuse(key, reason)
    for name, limit in config.constraints.limits.items():
        if limit.minimum is None and limit.maximum is None:
            refuse(f"constraints.limits.{name}", "needs min, max or both")
        if limit.minimum is not None and limit.maximum is not None and limit.minimum > limit.maximum:
            refuse(f"constraints.limits.{name}", f"min = {limit.minimum:g} is above max = {limit.maximum:g}")


def _unknown_number(config: StudyConfig, name: str) -> str | None:
    """Why there can be no such number; None if there may be."""
    if ":" in name or name in QUANTITIES:
        return None
    path = name.partition("(")[2].rstrip(")") if "(" in name else name
    first, _, rest = path.partition(".")
    if first not in ("parts", "flight", "objective_families") or not rest:
        near = difflib.get_close_matches(name, QUANTITIES, n=1)
        hint = f"did you mean {near[0]}?" if near else f"there are {', '.join(QUANTITIES)}, parts.…, flight.…"
        return f"no number {name!r}; {hint}"
    part = rest.partition(".")[0]
    known = [part.name for part in config.parts]
    if first == "parts" and part != "*" and part not in known:
        return f"{name!r}: no part {part!r}; there are {', '.join(known)}"
    return None
