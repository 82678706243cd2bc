"""`codesign fly`: any robot that has the study's joints and jets, without parts."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from codesign import dynamics as dyn
from codesign.chain.documents import flight_document, objective_families, objective_parts
from codesign.chain.flight import find_trajectory, flight_seeds, flight_settings, joint_names, refusals
from codesign.chain.judge import FLIGHT_MISSED, loss
from codesign.chain.provenance import provenance

if TYPE_CHECKING:
    from codesign.study import StudyData


def fly_robot(
    study: StudyData,
    robot: str | Path,
    trajectory: str | None = None,
    jets: str | None = None,
    as_published: bool = False,
) -> dict[str, Any]:
    """Flies any robot that has the study's joints and jets.

    Args:
        robot: path of a URDF or its text. trajectory, jets: instead of the study's. as_published: accept non-physical
            inertias.
    Returns: the JSON document of `codesign fly`.
    Raises: UrdfError, StudyError.
    """
    config = study.config
    name = trajectory or config.flown.trajectory
    settings = flight_settings(config.flown, find_trajectory(config, name), jets)
    seeds = flight_seeds(config, name)
    start = time.perf_counter()
    model = dyn.load_urdf(robot, joints=joint_names(config.flown), as_published=as_published)
    loaded = time.perf_counter()
    with refusals(study.path):
        logs = dyn.simulate_flights(model, settings, seeds)
    end = time.perf_counter()
    document = flight_document(name, logs, config.flown, end - loaded, seeds, settings.duration)
    completed = document["completed"]
    families = objective_families(logs)
    return {
        "robot": str(robot),
        "status": "completed" if completed else "lost",
        "reason": None if completed else loss(document),
        "objectives": families[config.objectives.family],
        "objective_families": families,
        "objective_parts": {family: objective_parts(logs[0], family, config) for family in ("rms", "script")},
        "constraints": {FLIGHT_MISSED: document["missed_share"]},
        "flight": document,
        "seconds": {"load": loaded - start, "flight": end - loaded, "total": end - start},
        "provenance": provenance(study),
    }
