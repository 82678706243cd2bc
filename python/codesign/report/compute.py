"""Details of a design: the study's chain once more, keeping the fields and histories that an Evaluation leaves out."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from codesign import fem
from codesign.chain.chain import evaluate_with_fields
from codesign.chain.flight import joint_names
from codesign.problem.design_space import DesignValue
from codesign.report.details import Detail, FlightHistory, StressField, flight_history
from codesign.storage.cache import default_cache_path, open_cache
from codesign.storage.designs import keep_evaluation


def compute_detail(study: Any, theta: Mapping[str, DesignValue], trajectory: str | None = None) -> Detail:
    """Evaluation, stress fields and flight history of a design; `trajectory`: by default the study's own.

    Raises: CodesignError where the chain does.
    """
    design = study.space.design(theta)
    evaluation, analyses, flight = evaluate_with_fields(study, design, trajectory)
    own = trajectory in (None, study.config.flown.trajectory if study.config.flight is not None else None)
    with open_cache(default_cache_path(study.name), study.identity.program) as cache:
        keep_evaluation(study, study.space.indices(design), evaluation, cache, "" if own else str(trajectory))
    fields = {name: stress_field(analysis.mesh, analysis.result) for name, analysis in analyses.items()}
    if flight is None:
        return Detail(evaluation, fields, None)
    flown = trajectory or study.config.flown.trajectory
    return Detail(evaluation, fields, history(study.configured(design).flown, flown, flight))


def history(flight: Any, trajectory: str, log: Any) -> FlightHistory:
    """Histories of a flight under a study's `[flight]` section."""
    groups = {group.name: list(group.joints) for group in flight.joint_groups if group.velocity_weight > 0}
    return flight_history(log, trajectory, tuple(flight.jets.frames), tuple(joint_names(flight)), groups)


def stress_field(mesh: fem.TetMesh, result: fem.StaticResult) -> StressField:
    """Von Mises stress on the boundary of a part's mesh; each quadratic triangle becomes four flat ones."""
    boundary = np.asarray(mesh.boundary)
    corners, middles = boundary[:, :3], boundary[:, 3:]
    (a, b, c), (ab, bc, ca) = corners.T, middles.T
    triangles = np.concatenate([np.stack(t, axis=1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
    used, index = np.unique(triangles, return_inverse=True)
    return StressField(
        points=np.asarray(mesh.nodes)[used],
        triangles=index.reshape(triangles.shape).astype(np.int64),
        von_mises=np.asarray(result.von_mises)[used],
        peak=float(result.peak_stress),
    )
