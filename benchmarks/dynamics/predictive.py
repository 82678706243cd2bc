"""Predictive control: time of a solve, ratio to OSQP on the same problems, time of a flight.

    python benchmarks/dynamics/predictive.py [--every 20]

Flies the route (30 s, 200 Hz), then makes its solves again from the log, in their order. Every n-th one is also solved
by OSQP in sparse form (588 unknowns), warm-started from its last solution, to residuals of 1e-4: matrices, vectors
and bounds are prepared before its clock starts, its update() counts. CPU time of both, alternating in one run; ours
includes linearization and condensing. Needs osqp and a release build.
"""

import argparse
import sys
import time
from pathlib import Path

import numpy as np
import osqp
from scipy.spatial.transform import Rotation

REPOSITORY = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(REPOSITORY / "tests" / "python"))

import ironcub_predictive as whole  # noqa: E402
from codesign import dynamics as dyn  # noqa: E402
from predictive_sparse import sparse_problem  # noqa: E402

CHEST = "chest"


class References:
    """References of the states along a path, as the controller makes them."""

    def __init__(self, settings: dyn.FlightSettings) -> None:
        chest = dyn.frame_pose(whole.robot(), settings.base_pose, settings.initial_joints, CHEST)
        self.com = dyn.center_of_mass(whole.robot(), settings.base_pose, settings.initial_joints)
        self.rpy = Rotation.from_matrix(chest[:3, :3]).as_euler("ZYX")[::-1]
        self.path = dyn.Path(settings.path)

    def now(self, seconds: float) -> tuple[np.ndarray, np.ndarray]:
        """Of center of mass and attitude."""
        value = self.path.at(seconds).value
        return self.com + value[:3], self.rpy + np.array([0.0, 0.0, value[3]])

    def state(self, model: dyn.PredictionModel, seconds: float) -> np.ndarray:
        """Of all 26 states; those without weight are zero."""
        point, reference = self.path.at(seconds), np.zeros(26)
        reference[:3], reference[6:9] = self.now(seconds)
        reference[3:6] = model.mass * model.world_R_body.T @ point.velocity[:3]
        turning = np.linalg.solve(model.rpy_rate, [0.0, 0.0, point.velocity[3]])
        reference[9:12] = turning
        return reference


class Osqp:
    """OSQP on problems of one structure."""

    def __init__(self) -> None:
        self.solver: osqp.OSQP | None = None

    def solve(self, problem) -> tuple[np.ndarray, float]:
        """Solution and CPU time [s] of update and solve."""
        upper = np.asarray(problem.P.todense())
        P = type(problem.P)(np.triu(upper))
        if self.solver is None:
            self.solver = osqp.OSQP()
            self.solver.setup(
                P, problem.q, problem.A, problem.lower, problem.upper, eps_abs=1e-4, eps_rel=1e-4, verbose=False
            )
            self.pattern = problem.A.indices.copy()
        assert np.array_equal(self.pattern, problem.A.indices)
        start = time.process_time()
        self.solver.update(q=problem.q, l=problem.lower, u=problem.upper, Ax=problem.A.data)
        result = self.solver.solve()
        return result.x, time.process_time() - start


def main() -> None:
    """Prints a line per figure."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--every", type=int, default=20)
    every = parser.parse_args().every
    settings = whole.settings(reference=False)
    settings.path = whole.route()
    start = time.process_time()
    log = dyn.simulate_flight(whole.robot(), settings)
    print(f"route, 200 Hz, implicit plant: {time.process_time() - start:.2f} s CPU, completed {log.completed}")
    controller, references, other = dyn.PredictiveController(whole.robot(), settings), References(settings), Osqp()
    home = settings.initial_joints + hold_angles(settings)
    controller.start(settings.base_pose, settings.initial_joints, settings.initial_thrusts, home)
    arms = [settings.joints.index(name) for name in whole.ARMS]
    ours, theirs, differences = [], [], []
    for k in range(log.samples):
        pose = np.eye(4)
        pose[:3, :3], pose[:3, 3] = log.base_rotation[k], log.base_position[k]
        variables, posture = controller.variables.copy(), controller.set_points[arms] - home[arms]
        began = time.process_time()
        controller.solve(k, pose, log.joint_positions[k], log.velocity[k], log.thrust[k], log.thrust_rate_command[k])
        spent = time.process_time() - began
        if k % every:
            continue
        seconds = k * settings.step
        rows = np.array([references.state(controller.prediction, seconds + end) for end in controller.step_ends])
        problem = sparse_problem(controller, settings.predictive, variables, posture, references.now(seconds), rows)
        x, taken = other.solve(problem)
        ours.append(spent)
        theirs.append(taken)
        differences.append(np.abs(x[problem.inputs] - controller.result.x).max())
    ours, theirs = np.array(ours[1:]), np.array(theirs[1:])
    print(
        f"{len(ours)} solves: ours {1e3 * np.median(ours):.3f} ms, OSQP {1e3 * np.median(theirs):.3f} ms (median CPU)"
    )
    print(f"ratio of sums OSQP / ours: {theirs.sum() / ours.sum():.1f}; largest difference of x {max(differences):.1e}")


def hold_angles(settings: dyn.FlightSettings) -> np.ndarray:
    """By how much set points lead the joints so that the servos carry the trimmed posture."""
    robot, count = whole.robot(), len(settings.joints)
    wrenches = {}
    for jet, thrust in zip(settings.actuators, settings.initial_thrusts, strict=True):
        pose = dyn.frame_pose(robot, settings.base_pose, settings.initial_joints, jet.frame)
        wrenches[jet.frame] = np.concatenate([-thrust * pose[:3, 2], np.zeros(3)])
    free = dyn.bias_forces(robot, settings.base_pose, settings.initial_joints, np.zeros(6 + count))
    for frame, wrench in wrenches.items():
        free -= dyn.frame_jacobian(robot, settings.base_pose, settings.initial_joints, frame).T @ wrench
    return free[6:] / settings.servo_plant.servo.stiffness


if __name__ == "__main__":
    main()
