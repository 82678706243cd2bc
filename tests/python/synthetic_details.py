"""Made-up details: the shipped parts with a smooth stress field, a flight with decaying errors."""

import numpy as np

from codesign.problem.evaluation import Evaluation
from codesign.report.details import Detail, FlightHistory, StressField
from codesign.studies.ironcub.bracket import JetpackBracket
from codesign.studies.ironcub.forearm import ForearmJetSupport


def field(part: object, peak: float) -> StressField:
    surface = part.surface(64)  # type: ignore[attr-defined]
    points = np.asarray(surface.points)
    along = points[:, 0] - points[:, 0].min()
    stress = peak * (
        0.05
        + 0.95 * np.exp(-((along / along.max() - 0.3) ** 2) / 0.05) * np.abs(points[:, 2]) / np.abs(points[:, 2]).max()
    )
    return StressField(points, np.asarray(surface.triangles), stress, peak)


def history(duration: float = 42.0) -> FlightHistory:
    time = np.arange(0.0, duration + 1e-9, 0.04)
    wave = np.exp(-time / 3) + 0.06 * np.sin(0.9 * time) ** 2
    arrays = {
        "time": time,
        "com_error": 0.15 * wave,
        "attitude_error": 0.06 * wave,
        "thrust": np.stack(
            [120 + 30 * np.sin(0.3 * time), 121 + 29 * np.sin(0.3 * time), 205 + 10 * wave, 205 - 9 * wave], 1
        ),
        "joint_velocity_error": np.stack([0.2 * wave, 0.3 * wave, 0.31 * wave], 1),
        "base_position": np.stack([0.1 * time, 0 * time, 0.8 + 0.05 * time], 1),
        "base_rotation": np.broadcast_to(np.eye(3), (len(time), 3, 3)),
        "joint_positions": np.zeros((len(time), 23)),
        "com": np.stack([0.1 * time, 0 * time, 0.8 + 0.05 * time], 1),
        "com_reference": np.stack([0.1 * time, 0 * time, 0.8 + 0.05 * time], 1),
        "qp_iterations": np.ones((len(time), 2)),
        "active_bounds": 4 * np.ones(len(time)),
    }
    jets = ("l_arm_jet_turbine", "r_arm_jet_turbine", "chest_l_jet_turbine", "chest_r_jet_turbine")
    return FlightHistory(
        "envelope", jets, ("torso", "left_arm", "right_arm"), tuple(f"j{i}" for i in range(23)), arrays
    )


def detail(evaluation: Evaluation) -> Detail:
    d = evaluation.design
    parts = {
        "jetpack_bracket": field(JetpackBracket(d["angle"], d["distance"]), 5.3e6),
        "forearm_support": field(ForearmJetSupport(d["offset"], d["length"]), 22e6),
    }
    return Detail(evaluation, parts, history())
