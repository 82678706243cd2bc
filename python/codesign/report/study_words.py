"""A study in words: what its objectives sum up, how its parts are loaded and held, of what they are made."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from codesign.problem.quantities import Quantity, quantity, words
from codesign.report.data import PartWords
from codesign.report.words import listed, plural
from codesign.study.config import FemConfig, LoadCaseConfig, MassOnFaceConfig, PartConfig, StudyConfig
from codesign.study.flight_config import JointGroupConfig
from codesign.study.load_config import LOAD_KINDS, LoadConfig
from codesign.study.sections import Vector3

TIMES = {0.5: "half", 1.0: "once", 2.0: "twice"}


def objective_quantities(keys: Sequence[str], config: StudyConfig | None) -> tuple[Quantity, ...]:
    """What the table says of the objectives, with what this study makes of them. config: None if it is not known."""
    if config is None:
        return tuple(quantity(key) for key in keys)
    known = (quantity(key, config.objectives.family) for key in keys)
    return tuple(_with_groups(q, config) if q.key == "joint_velocity" and q.meaning else q for q in known)


def _with_groups(velocity: Quantity, config: StudyConfig) -> Quantity:
    groups = config.flown.joint_groups
    counted = [f"{words(g.name).lower()} counted {_times(g)}" for g in groups if g.velocity_weight > 0]
    ignored = [words(g.name).lower() for g in groups if g.velocity_weight == 0]
    said = f"In this study: {listed(counted)}" if counted else "In this study no joint group is counted"
    said += f"; {listed(ignored)} not counted." if counted and ignored else "."
    return replace(velocity, meaning=f"{velocity.meaning} {said}")


def _times(group: JointGroupConfig) -> str:
    weight = group.velocity_weight
    return TIMES.get(weight, f"{weight:g} times")


def part_words(config: StudyConfig) -> dict[str, PartWords]:
    """Load case and material of every part, with a warning where its density is not that of its material."""
    return {
        part.name: PartWords(
            _load_case(config, part),
            _material(config, part),
            _warning(config, part),
            {case.name: _loads(case) for case in part.load_cases},
            _held(config, part),
            listed([mass_words(mass) for mass in part.masses]),
        )
        for part in config.parts
    }


def _load_case(config: StudyConfig, part: PartConfig) -> str:
    loads = "; ".join(_case(case, len(part.load_cases) > 1) for case in part.load_cases)
    carried = f", with {listed([mass_words(mass) for mass in part.masses])}" if part.masses else ""
    return f"{loads}, {_held(config, part)}{carried}"


def _held(config: StudyConfig, part: PartConfig) -> str:
    """Which faces are held, and the part's own variants of load and support where they are not the usual ones."""
    held = (
        f"{'face' if len(part.supports) == 1 else 'faces'} {listed(part.supports)} held"
        if part.supports
        else "not held"
    )
    models = [("load", config.fem.load, FemConfig().load), ("support", config.fem.support, FemConfig().support)]
    chosen = listed([f"the part's own {kind} “{name}”" for kind, name, usual in models if name != usual])
    return held + (f" ({chosen})" if chosen else "")


def _case(case: LoadCaseConfig, named: bool) -> str:
    asked = f", at least {case.safety_factor_min:g} times" if case.safety_factor_min is not None else ""
    return f"{case.name}: {_loads(case)}{asked}" if named else _loads(case)


def _loads(case: LoadCaseConfig) -> str:
    return listed([load_words(load) for load in case.loads] or [_flown(case)])


def mass_words(mass: MassOnFaceConfig) -> str:
    """A rigid body that a face carries: `0.14 kg on face seat at (0, 0, 18) mm of motor`."""
    of = f" of {mass.interface}" if mass.interface else ""
    return f"{mass.mass_kg:g}\u202fkg on face {mass.face} at {_vector(mass.point_mm)}\u202fmm{of}"


def _flown(case: LoadCaseConfig) -> str:
    seats = listed([f"{interface} on face {face}" for interface, face in case.flown.items()])
    return f"loads of the flight at every sample, of what hangs at {seats}, and the part's own weight and inertia"


def load_words(load: LoadConfig) -> str:
    """A load with its numbers and units."""
    kind, value = LOAD_KINDS[load.kind], getattr(load, load.kind)
    number = f"{_vector(value)}\u202f{kind.unit}" if isinstance(value, tuple) else f"{value:g}\u202f{kind.unit}"
    if not kind.on_face:
        return f"{kind.verb} {number}"
    axes = f" in axes of {load.interface}" if load.interface else ""
    remote = f" at {_vector(load.point_mm)}\u202fmm" if load.point_mm else ""
    moment = f" with {_vector(load.moment_n_m)}\u202fN\u202fm" if load.force_n and load.moment_n_m else ""
    return f"{number}{moment}{remote}{axes} {kind.verb} face {load.face}"


def _vector(value: Vector3) -> str:
    return f"({', '.join(f'{x:g}' for x in value)})"


def _material(config: StudyConfig, part: PartConfig) -> str:
    material = config.materials[part.material]
    return (
        f"{words(part.material)}: E {material.young_modulus_gpa:g}\u202fGPa, yield strength "
        f"{material.yield_strength_mpa:g}\u202fMPa, {material.density_kg_m3:g}\u202fkg/m³"
    )


def _warning(config: StudyConfig, part: PartConfig) -> str:
    used, own = part.density_kg_m3, config.materials[part.material].density_kg_m3
    if used is None or used == own:
        return ""
    material, name = words(part.material), words(part.name).lower()
    return (
        f"The stress of the {name} is that of {material}, its mass is computed with {used:g}\u202fkg/m³ instead of "
        f"{own:g}: made of {material} it weighs {100 * own / used:.0f}\u202f% of the mass shown, and the robot flies "
        "otherwise."
    )


def flight_words(config: StudyConfig) -> str:
    """What one flight is, and what its numbers are good for."""
    flight = config.flight
    if flight is None:
        return "No flight: the parts alone are judged."
    trajectory = config.trajectories[flight.trajectory]
    seconds = trajectory.duration_s or flight.duration_s
    calm = "calm" if trajectory.disturbances == type(trajectory.disturbances)() else "disturbed"
    draws = len(flight.seeds)
    what = f"Means of {draws} {calm} flights" if draws > 1 else f"One {calm} flight"
    return (
        f"{what} of {seconds:g}\u202fs with {plural(len(flight.jets.frames), flight.jets.kind)}, simulated "
        f"in steps of {1e3 * flight.step_s:g}\u202fms. The step enters the numbers, so they compare designs with each "
        "other rather than predict the robot's."
    )
