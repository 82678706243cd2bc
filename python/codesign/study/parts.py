"""Parts of a study: building them from a design, and what is wrong with how the study names their options and faces."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np

from codesign.errors import CodesignError, ModelError
from codesign.geometry.shape import face_names
from codesign.parts.load_case import held_face, pressing_direction, require_bearing
from codesign.parts.part import Part
from codesign.problem.design_space import Design, DesignValue
from codesign.robot.assembly import PartBody, assemble, place_carried
from codesign.robot.description import RobotDescription
from codesign.robot.inertial import Inertial
from codesign.study.checking.cancelling import cancelled_case
from codesign.study.checking.problems import Problem, unknown
from codesign.study.choices import numbers_of
from codesign.study.config import LoadCaseConfig, PartConfig, StudyConfig
from codesign.transforms import Matrix
from codesign.units import MILLIMETER

SAME_BODY, SAME_PLACE = 1e-3, 1e-4  # of two descriptions of a body: relative difference of masses, distance [m]


def make_part(part: PartConfig, config: StudyConfig, part_class: type[Part], design: Mapping[str, DesignValue]) -> Part:
    """A part of a design. Raises: GeometryError if the design gives no sound part."""
    make: Callable[..., Part] = part_class
    numbers = numbers_of(config, design)
    parameters = {parameter: numbers[variable] for parameter, variable in part.parameters.items()}
    density = part.density_kg_m3 or config.materials[part.material].density_kg_m3
    return make(**parameters, **part.options, density=density)


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


def carried_bodies(part: PartConfig) -> dict[str, Inertial]:
    """What hangs on interfaces of a part, in their axes, as its masses say."""
    return {
        mass.interface: Inertial(
            mass.mass_kg, MILLIMETER * np.array(mass.point_mm), np.diag(np.array(mass.inertia_kg_m2, dtype=float))
        )
        for mass in part.masses
        if mass.interface
    }


def built_problems(
    config: StudyConfig, part_classes: Mapping[str, type[Part]], robot: RobotDescription, designs: Sequence[Design]
) -> Iterator[Problem]:
    """What building the parts shows: options, faces, places. designs: tried in turn until a part can be built.

    No mesh is made: the shape is only written down. A part that no design gives is left to its evaluation.
    """
    yield from _variant_problems(config, part_classes)
    for part in config.parts:
        part_class = part_classes[part.name]
        wrong_options = list(_option_problems(part, part_class))
        yield from wrong_options
        if wrong_options:
            continue
        try:
            built = _first_built(part, config, part_class, designs)
            if built is not None:
                yield from _face_problems(part, config, built)
                yield from _place_problems(part, robot, built)
        except (Exception, SystemExit) as error:  # whatever a user's class raises
            cause = f"{type(error).__name__}: {error}"
            yield f"parts.{part.name}", f"{part.shape} with options {part.options} cannot be built: {cause}"


def _first_built(
    part: PartConfig, config: StudyConfig, part_class: type[Part], designs: Sequence[Design]
) -> Part | None:
    for design in designs:
        try:
            return make_part(part, config, part_class, design)
        except CodesignError:
            continue
    return None


def _option_problems(part: PartConfig, part_class: type[Part]) -> Iterator[Problem]:
    taken = inspect.signature(part_class).parameters
    free = [name for name in taken if name not in part.parameters and name != "density"]
    if not any(parameter.kind is parameter.VAR_KEYWORD for parameter in taken.values()):
        for option in part.options:
            yield from unknown(f"parts.{part.name}.options", f"option of {part.shape}", option, free)


def _variant_problems(config: StudyConfig, part_classes: Mapping[str, type[Part]]) -> Iterator[Problem]:
    """Variants of load and support are the parts' own: one that no part offers would be read by nobody."""
    for key in ("load", "support"):
        offered = {name for part_class in part_classes.values() for name in getattr(part_class, f"{key}_variants")}
        yield from unknown(f"fem.{key}", "variant of any part", getattr(config.fem, key), sorted(offered))


def _face_problems(part: PartConfig, config: StudyConfig, built: Part) -> Iterator[Problem]:
    if type(built).fem_surface is not Part.fem_surface:
        return  # a surface from elsewhere: its faces are known once it is there
    named = face_names(built.fem_shape(config.fem.geometry))
    surface = None if hasattr(built, "stress_case") else built.fem_surface(config.fem.geometry)
    held = {held_face(text)[0] for text in part.supports}
    for face in held:
        yield from unknown(f"parts.{part.name}.supports", "face", face, named)
    for mass in part.masses:
        yield from unknown(f"parts.{part.name}.masses", "face", mass.face, named)
        if mass.interface:
            yield from unknown(f"parts.{part.name}.masses", "interface", mass.interface, list(built.interfaces()))
    for case in part.load_cases:
        yield from _seat_problems(part, case, built, named)
        if why := cancelled_case(case, surface):
            yield _loads_key(part, case), why
        for load in (load for load in case.loads if load.face):
            key = _loads_key(part, case)
            if load.interface:
                yield from unknown(key, "interface", load.interface, list(built.interfaces()))
            yield from unknown(key, "face", load.face, named)
            if load.face in held:
                yield key, f"the load acts on {load.face!r}, which is held"
            if surface is not None and load.face in surface.face_names:
                try:
                    if load.pressing_n is not None:
                        pressing_direction(surface, load.face)
                    if load.bearing_n is not None:
                        require_bearing(surface, load.face, load.bearing_n)
                except ModelError as error:
                    yield key, f"{load.kind} on {error}"


def _seat_problems(part: PartConfig, case: LoadCaseConfig, built: Part, faces: Sequence[str]) -> Iterator[Problem]:
    """Interfaces and faces of a flown case, and whether anything hangs on them."""
    key = f"parts.{part.name}.cases[{case.name}].flown"
    used = {attachment.interface for place in part.placements for attachment in place.joints.values()}
    for interface, face in case.flown.items():
        yield from unknown(key, "interface", interface, list(built.interfaces()))
        yield from unknown(key, "face", face, faces)
        if face in {held_face(text)[0] for text in part.supports}:
            yield key, f"what hangs on {interface!r} pushes on {face!r}, which is held"
        if interface in built.interfaces() and interface not in used:
            yield key, f"no joint of the placements hangs on {interface!r}: nothing would push on {face!r}"


def _loads_key(part: PartConfig, case: LoadCaseConfig) -> str:
    return f"parts.{part.name}.cases[{case.name}].loads" if part.cases else f"parts.{part.name}.loads"


def bodies_given_twice(config: StudyConfig, robot: RobotDescription) -> Iterator[Problem]:
    """Bodies that hang on a part and weigh otherwise in the robot's file than in the study's, fixed links as one."""
    for part in config.parts:
        carried = carried_bodies(part)
        told = set()
        for place in part.placements:
            for joint, attachment in place.joints.items():
                child = robot.joint(joint).child
                body, (mass, moment) = carried.get(attachment.interface), _fixed_mass(robot, child)
                if body is None or mass == 0.0 or attachment.interface in told:
                    continue
                mine = place_carried(place, attachment, body)
                apart = float(np.linalg.norm(mine.com - moment / mass))
                if abs(mine.mass - mass) > SAME_BODY * mass:
                    differs = f"mass than the robot's link {child!r} ({mine.mass:g} and {mass:g} kg)"
                elif apart > SAME_PLACE and place.mirror is None:  # axes of mirrored links are as their author likes
                    differs = f"center of mass than the robot's link {child!r} ({1e3 * apart:.3g} mm apart)"
                else:
                    continue
                told.add(attachment.interface)
                yield (
                    f"parts.{part.name}.masses",
                    f"what hangs on {attachment.interface!r} has another {differs}; if they are one body, give the "
                    "link no mass: it takes these numbers then",
                )


def _fixed_mass(robot: RobotDescription, link: str) -> tuple[float, Matrix]:
    """Mass [kg] of a link with all that is fixed to it, and its moment (3,) [kg m] in the link's axes."""
    own = robot.inertial(link)
    mass, moment = (0.0, np.zeros(3)) if own is None else (own.mass, own.mass * own.com)
    for name in robot.joint_names:
        joint = robot.joint(name)
        if joint.parent == link and joint.type == "fixed":
            below, there = _fixed_mass(robot, joint.child)
            T = robot.joint_origin(name)
            mass, moment = mass + below, moment + T[:3, :3] @ there + below * T[:3, 3]
    return mass, moment


def _place_problems(part: PartConfig, robot: RobotDescription, built: Part) -> Iterator[Problem]:
    body = PartBody(Inertial(1.0, np.zeros(3), np.eye(3)), built.interfaces())
    for place in part.placements:
        key = f"parts.{part.name}.placements"
        missing = list(unknown(key, "link", place.link, robot.link_names))
        for joint, attachment in place.joints.items():
            missing += unknown(f"{key}.joints", "joint", joint, robot.joint_names)
            missing += unknown(f"{key}.joints.{joint}", "interface", attachment.interface, body.interfaces)
        yield from missing
        if not missing:
            try:
                assemble(robot, {part.name: [place]}, {part.name: body})
            except CodesignError as error:
                yield key, str(error)
