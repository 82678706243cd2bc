"""Cross-references and bounds of a study that types cannot express."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from codesign.errors import StudyError
from codesign.parts.part import Part, parameter_units
from codesign.study.config import StudyConfig


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
    for objective in config.objectives.minimise:
        if objective not in ("momentum", "joint_velocity", "thrust"):
            refuse("objectives.minimise", f"no objective {objective!r}; there are momentum, joint_velocity, thrust")
