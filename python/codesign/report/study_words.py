"""A study in words: what its objectives sum up, how its parts are loaded and held, of what they are made."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from codesign.problem.quantities import Quantity, quantity, words
from codesign.report.words import listed, plural
from codesign.study.config import JointGroupConfig, LoadConfig, PartConfig, StudyConfig

TIMES = {0.5: "half", 1.0: "once", 2.0: "twice"}


def objective_quantities(keys: Sequence[str], config: StudyConfig | None) -> tuple[Quantity, ...]:
    """What the table says of the objectives, with what this study makes of them. config: None if it is not known."""
    if config is None:
        return tuple(quantity(key) for key in keys)
    known = (quantity(key, config.objectives.family) for key in keys)
    return tuple(_with_groups(q, config) if q.key == "joint_velocity" and q.meaning else q for q in known)


def _with_groups(velocity: Quantity, config: StudyConfig) -> Quantity:
    groups = config.flight.joint_groups
    counted = [f"{words(g.name).lower()} counted {_times(g)}" for g in groups if g.velocity_weight > 0]
    ignored = [words(g.name).lower() for g in groups if g.velocity_weight == 0]
    said = f"In this study: {listed(counted)}" if counted else "In this study no joint group is counted"
    said += f"; {listed(ignored)} not counted." if counted and ignored else "."
    return replace(velocity, meaning=f"{velocity.meaning} {said}")


def _times(group: JointGroupConfig) -> str:
    weight = group.velocity_weight
    return TIMES.get(weight, f"{weight:g} times")


def load_words(config: StudyConfig, name: str) -> str:
    """A part's load case: `250 N pressing on seat, mount clamped (load model uniform, support model published)`."""
    part = _part(config, name)
    loads = listed([_load(load) for load in part.loads]) or "no load"
    held = f"{listed(part.supports)} held" if part.supports else "not held"
    return f"{loads}, {held} (load model “{config.fem.load}”, support model “{config.fem.support}”)"


def _load(load: LoadConfig) -> str:
    return f"{load.pressing_n:g}\u202fN pressing on {load.face}"


def material_words(config: StudyConfig, name: str) -> str:
    """What a part's stress and mass are computed with; says so if its density is not that of its material."""
    part = _part(config, name)
    material = config.materials[part.material]
    text = (
        f"{words(part.material)}: E {material.young_modulus_gpa:g}\u202fGPa, yield strength "
        f"{material.yield_strength_mpa:g}\u202fMPa, {material.density_kg_m3:g}\u202fkg/m³"
    )
    return text if not other_density(config, name) else f"{text}. {density_warning(config, name)}"


def other_density(config: StudyConfig, name: str) -> bool:
    """Whether a part's mass is computed with a density that is not its material's."""
    part = _part(config, name)
    return part.density_kg_m3 not in (None, config.materials[part.material].density_kg_m3)


def density_warning(config: StudyConfig, name: str) -> str:
    """That a part's stress and its mass are of two materials, and what it would weigh in the one that is named."""
    part = _part(config, name)
    used, own = part.density_kg_m3 or 0.0, config.materials[part.material].density_kg_m3
    return (
        f"The mass is computed with {used:g}\u202fkg/m³ instead: made of {words(part.material).lower()} the "
        f"{words(name).lower()} weighs {100 * own / used:.0f}\u202f% of the mass shown, and the robot flies otherwise."
    )


def flight_words(config: StudyConfig) -> str:
    """What one flight is, and what its numbers are good for."""
    flight = config.flight
    trajectory = config.trajectories[flight.trajectory]
    calm = "calm" if trajectory.disturbances == type(trajectory.disturbances)() else "disturbed"
    return (
        f"One {calm} flight of {flight.duration_s:g}\u202fs with {plural(len(flight.jets.frames), 'jet')}, simulated "
        f"in steps of {1e3 * flight.step_s:g}\u202fms. The step enters the numbers, so they compare designs with each "
        "other rather than predict the robot's."
    )


def _part(config: StudyConfig, name: str) -> PartConfig:
    return next(part for part in config.parts if part.name == name)
