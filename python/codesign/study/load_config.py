"""A load of a part as written in study.toml, and what it is to the solver: all of a kind of load stands here."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from codesign import fem
from codesign.parts.load_case import InterfaceForce, PartLoad, PressedFace, PushedFace
from codesign.study.sections import Section, Vector3
from codesign.units import MEGA, MILLIMETER

ZERO = (0.0, 0.0, 0.0)


class LoadConfig(Section, frozen=True, kw_only=True):
    """One load of a part: one kind of it.

    pressing_n: total force on a face, against its mean outward normal. force_n: total force on a face, a vector in part
    axes, for round faces, whose normals cancel, say. Both spread uniformly. With point_mm or moment_n_m the force acts
    at that point (of part axes) and has that moment about it: a remote force, affine over the face. interface: point,
    force and moment are in the axes of this interface of the part, and move with it. pressure_mpa: against the outward
    normal everywhere. bearing_n: total force by pressure alone, as a pin presses on a bore. moment_n_m alone: a moment
    on a face. traction_mpa: force per area, the same everywhere. acceleration_m_s2: a field
    like gravity on the whole part, without a face.
    """

    face: str = ""
    pressing_n: float | None = None
    force_n: Vector3 | None = None
    interface: str = ""
    point_mm: Vector3 | None = None
    moment_n_m: Vector3 | None = None
    bearing_n: Vector3 | None = None
    pressure_mpa: float | None = None
    traction_mpa: Vector3 | None = None
    acceleration_m_s2: Vector3 | None = None

    @property
    def kind(self) -> str:
        """The key that says what the load is."""
        return next(name for name in LOAD_KINDS if getattr(self, name) is not None)

    def __post_init__(self) -> None:
        given = [name for name in LOAD_KINDS if getattr(self, name) is not None]
        if "force_n" in given and "moment_n_m" in given:
            given.remove("moment_n_m")
        if len(given) != 1:
            said = " and ".join(given) or "nothing"
            raise ValueError(f"a load needs exactly one of {', '.join(LOAD_KINDS)}; given {said}")
        value = getattr(self, given[0])
        remote = self.point_mm is not None or self.interface
        if remote and self.force_n is None and self.moment_n_m is None:
            raise ValueError("point_mm and interface belong to force_n and moment_n_m")
        if not any(value if isinstance(value, tuple) else (value,)) and not any(self.moment_n_m or ()):
            raise ValueError(f"{given[0]} of a load is zero")
        if bool(self.face) == (given[0] == "acceleration_m_s2"):
            raise ValueError("a load names its face, but for acceleration_m_s2, which acts on the whole part")


@dataclass(frozen=True, slots=True)
class LoadKind:
    """What a key of a load means.

    solved: the load in SI units from all its keys and the value of this one; total forces on faces are the part's to
    interpret. unit, verb: of a sentence about it. on_face: whether it acts on a face or on the whole part.
    """

    solved: Callable[[LoadConfig, Any], PartLoad]
    unit: str
    verb: str = "on"
    on_face: bool = True


def _remote(load: LoadConfig, _: Vector3) -> PartLoad:
    force, moment = load.force_n or ZERO, load.moment_n_m or ZERO
    x, y, z = (MILLIMETER * value for value in load.point_mm or ZERO)
    if load.interface:
        return InterfaceForce(load.face, load.interface, force, (x, y, z), moment)
    if load.point_mm is None and load.moment_n_m is None:
        return PushedFace(load.face, force)
    return fem.AffineTraction(load.face, force, (x, y, z), moment)


LOAD_KINDS = {
    "pressing_n": LoadKind(lambda load, force: PressedFace(load.face, force), "N", "pressing on"),
    "force_n": LoadKind(_remote, "N"),
    "moment_n_m": LoadKind(_remote, "N\u202fm"),
    "bearing_n": LoadKind(lambda load, force: fem.BearingLoad(load.face, force), "N", "of a pin on"),
    "pressure_mpa": LoadKind(lambda load, value: fem.Pressure(load.face, value * MEGA), "MPa", "pressure on"),
    "traction_mpa": LoadKind(
        lambda load, value: fem.Traction(load.face, tuple(x * MEGA for x in value)), "MPa", "traction on"
    ),
    "acceleration_m_s2": LoadKind(lambda _, value: fem.Acceleration(value), "m/s²", "acceleration", on_face=False),
}


def part_load(load: LoadConfig) -> PartLoad:
    """One load in SI units."""
    return LOAD_KINDS[load.kind].solved(load, getattr(load, load.kind))
