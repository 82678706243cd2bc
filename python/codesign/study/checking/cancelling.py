"""Loads of a case that cancel: equal and opposite ones at the same place, which leave nothing that acts there."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from codesign import fem
from codesign.study.checking.problems import Problem
from codesign.study.config import LoadCaseConfig, StudyConfig
from codesign.study.load_config import ZERO, LoadConfig
from codesign.transforms import Matrix
from codesign.units import MEGA, MILLIMETER

NOTHING = 1e-9  # of what is added up, relative
FLAT = 1.0 - 1e-9  # length of a face's mean normal from which on it is flat

Place = tuple[str, ...]  # what acts where


def cancelled_case(case: LoadCaseConfig, surface: fem.SurfaceMesh | None) -> str | None:
    """Why nothing acts on a part in a load case; None if something does. surface: of the part, if it is known."""
    places = _places(case.loads, surface)
    if not places or not all(_cancels(loads) for loads in places.values()):
        return None
    where = ", ".join(dict.fromkeys(repr(place[0]) if place[0] else "the whole part" for place in places))
    return f"its loads cancel: on {where} they add up to nothing, so nothing acts on the part"


def cancelled_loads(config: StudyConfig) -> Iterator[Problem]:
    """Loads of a case that cancel where others act; of kinds that can be compared without the part's shape."""
    for part in config.parts:
        for case in part.load_cases:
            for place, loads in _places(case.loads, None).items():
                if _cancels(loads):
                    key = f"parts.{part.name}.cases[{case.name}].loads" if part.cases else f"parts.{part.name}.loads"
                    where = repr(place[0]) if place[0] else "the whole part"
                    yield key, f"{len(loads)} loads on {where} ({place[1]}) cancel: they change nothing"


def _cancels(loads: Sequence[Matrix]) -> bool:
    size = sum(float(np.linalg.norm(load)) for load in loads)
    return len(loads) > 1 and float(np.linalg.norm(np.sum(loads, axis=0))) <= NOTHING * size


def _places(loads: Sequence[LoadConfig], surface: fem.SurfaceMesh | None) -> dict[Place, list[Matrix]]:
    """Loads that act in the same way at the same place together, as vectors that add up."""
    found: dict[Place, list[Matrix]] = {}
    for load in loads:
        place, value = _acting(load, _area(surface, load.face))
        if load.bearing_n is None:  # pins on opposite sides of a bore do not cancel
            found.setdefault(place, []).append(value)
        else:
            found[load.face, load.kind, str(len(found))] = [value]
    return found


def _acting(load: LoadConfig, area: tuple[Matrix, float] | None) -> tuple[Place, Matrix]:
    """What a load is: a force spread evenly over its face where it can be told to be one. area: as `_area` has it."""
    value = np.atleast_1d(np.asarray(getattr(load, load.kind), dtype=float))
    if load.interface or load.point_mm is not None or load.moment_n_m is not None:
        force, moment = np.array(load.force_n or ZERO), np.array(load.moment_n_m or ZERO)
        about = moment + np.cross(MILLIMETER * np.array(load.point_mm or ZERO), force)
        return (load.face, "remote", load.interface), np.concatenate([force, about])
    if area is not None and load.traction_mpa is not None:
        return (load.face, "force_n"), MEGA * area[1] * value
    length = float(np.linalg.norm(area[0])) if area is not None else 0.0
    if area is not None and load.pressing_n is not None and length > 0.0:
        return (load.face, "force_n"), -value * area[0] / length
    if area is not None and load.pressure_mpa is not None and length >= FLAT * area[1]:
        return (load.face, "force_n"), -MEGA * value * area[0]
    return (load.face, load.kind), value


def _area(surface: fem.SurfaceMesh | None, face: str) -> tuple[Matrix, float] | None:
    """Sum of the outward area vectors (3,) of a named face [m²], and its area; None if there is no such face."""
    if surface is None or face not in surface.face_names:
        return None
    corners = surface.points[surface.triangles[np.asarray(surface.face) == surface.face_names.index(face)]]
    vectors = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return vectors.sum(axis=0), float(np.linalg.norm(vectors, axis=1).sum())
