"""Single solves of the predictive controller against an independent implementation; identities of its model."""

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.sparse.linalg import splu
from scipy.spatial.transform import Rotation

import ironcub_flight
import ironcub_predictive as whole
from codesign import dynamics as dyn
from predictive_sparse import sparse_problem

HOVER_VARIABLES = [1.005879, 1.010897, 0.806250, 0.812697]


def test_trim_of_the_original() -> None:
    hover = whole.trim()
    assert hover.reached
    np.testing.assert_allclose(hover.thrusts, [178.78, 179.17, 163.98, 164.46], atol=0.08)
    arms = [hover.joints[ironcub_flight.JOINTS.index(name)] for name in whole.ARMS]
    np.testing.assert_allclose(np.rad2deg(arms), [-6.81, 23.96, 41.50, 12.62, -6.78, 23.88, 41.51, 12.68], atol=6e-3)
    pitch = np.rad2deg(np.arcsin(-hover.base_pose[2, 0]))
    assert pitch == pytest.approx(2.83, abs=6e-3)
    throttles = [whole.MK3.throttle(whole.MK3.steady_variable(thrust)) for thrust in hover.thrusts]
    np.testing.assert_allclose(throttles, [79.2, 79.4, 72.9, 73.1], atol=0.1)  # 0.08 N


def twist_in_world(base_pose: np.ndarray, twist: list[float]) -> np.ndarray:
    """A twist of the root link in its own axes as velocities in world axes."""
    rotation = base_pose[:3, :3]
    return np.concatenate([rotation @ twist[:3], rotation @ twist[3:]])


def solved(recommended: bool, moving: bool) -> dyn.PredictiveController:
    settings, hover = whole.settings(recommended), whole.trim()
    settings.path = whole.step()
    controller = dyn.PredictiveController(whole.robot(), settings)
    controller.start(hover.base_pose, hover.joints, hover.thrusts, hover.joints)
    velocity, rates = np.zeros(whole.robot().dofs), np.zeros(4)
    if moving:
        velocity[:6] = twist_in_world(hover.base_pose, [0.1, -0.05, 0.2, 0.1, 0.2, -0.3])
        rates = np.array([5.0, -5.0, 10.0, 0.0])
    k = settings.predictive.throttle_every  # after the reference's jump, with an update of the throttles
    assert controller.solve(k, hover.base_pose, hover.joints, velocity, hover.thrusts, rates) == dyn.QpStatus.solved
    return controller


@pytest.mark.parametrize(
    ("recommended", "moving", "joints", "variables", "trace", "gradient"),
    [
        (
            False,
            False,
            [0.003109, -0.003558, 0.001369, -0.000043, 0.002931, -0.000650, 0.000880, -0.002099],
            [1.014710, 1.016810, 0.810595, 0.813344],
            1.2280264e7,
            154225.11,
        ),
        (
            False,
            True,
            [-0.005590, -0.002354, 0.000965, 0.004055, 0.000191, 0.004779, 0.000348, -0.003814],
            [0.988421, 0.999748, 0.783187, 0.796438],
            None,
            161353.38,
        ),
        (
            True,
            True,
            [-0.010000, -0.003497, 0.001700, 0.006278, -0.003247, 0.008215, -0.000410, -0.002951],
            [0.983927, 0.991173, 0.790297, 0.798863],
            1.3159785e7,
            217894.22,
        ),
    ],
)
def test_one_solve_agrees_with_an_independent_implementation(
    recommended: bool,
    moving: bool,
    joints: list[float],
    variables: list[float],
    trace: float | None,
    gradient: float,
) -> None:
    controller = solved(recommended, moving)
    x = controller.result.x
    first, throttle = controller.joint_columns[0], controller.throttle_columns[0]
    np.testing.assert_allclose(x[first : first + 8], joints, atol=1e-5)
    # The robots' tessellations differ, and trim thrusts by 0.07 N: what the solve changes is compared.
    steady = [whole.MK3.steady_variable(thrust) for thrust in whole.trim().thrusts]
    change = np.array(variables) - HOVER_VARIABLES
    np.testing.assert_allclose(x[throttle : throttle + 4] - steady, change, atol=2e-5)
    if trace is not None:
        assert np.trace(controller.hessian) == pytest.approx(trace, rel=2e-4)
    assert np.linalg.norm(controller.gradient) == pytest.approx(gradient, rel=5e-4)
    assert (x >= controller.lower).all() and (x <= controller.upper).all()
    assert controller.result.kkt_residual <= 1e-9


def moving_controller(rng: np.random.Generator) -> tuple[dyn.PredictiveController, dyn.FlightSettings, dict]:
    """A controller in the air with tilt, joint and base velocities; its state."""
    settings, hover = whole.settings(), whole.trim()
    controller = dyn.PredictiveController(whole.robot(), settings)
    controller.start(hover.base_pose, hover.joints, hover.thrusts, hover.joints)
    base_pose = hover.base_pose.copy()
    base_pose[:3, :3] = Rotation.from_rotvec(rng.uniform(-0.3, 0.3, 3)).as_matrix() @ base_pose[:3, :3]
    state = {
        "base_pose": base_pose,
        "joints": hover.joints + rng.uniform(-0.1, 0.1, len(hover.joints)),
        "velocity": rng.uniform(-0.5, 0.5, whole.robot().dofs),
        "thrusts": hover.thrusts + rng.uniform(-20.0, 20.0, 4),
        "thrust_rates": rng.uniform(-20.0, 20.0, 4),
    }
    return controller, settings, state


def wrench_in_body(state: dict, joints: np.ndarray) -> np.ndarray:
    """Force and moment of the jets about the center of mass in axes of the chest, which stays where it is."""
    robot = whole.robot()
    rotation = dyn.frame_pose(robot, state["base_pose"], joints, "chest")[:3, :3]
    com = dyn.center_of_mass(robot, state["base_pose"], joints)
    total = np.zeros(6)
    for frame, thrust in zip(ironcub_flight.JETS, state["thrusts"], strict=True):
        pose = dyn.frame_pose(robot, state["base_pose"], joints, frame)
        force = -thrust * pose[:3, 2]
        total += np.concatenate([rotation.T @ force, rotation.T @ np.cross(pose[:3, 3] - com, force)])
    return total


@pytest.mark.parametrize("seed", range(3))
def test_joint_maps_are_derivatives_of_the_wrench(seed: int) -> None:
    controller, _, state = moving_controller(np.random.default_rng(seed))
    controller.solve(0, **state)
    model = controller.prediction
    maps = np.vstack([model.force_of_joint, model.moment_of_joint])
    step = 1e-5
    for column, name in enumerate(whole.ARMS):
        shift = np.zeros(len(ironcub_flight.JOINTS))
        shift[ironcub_flight.JOINTS.index(name)] = step
        ahead = wrench_in_body(state, state["joints"] + shift)
        difference = (ahead - wrench_in_body(state, state["joints"] - shift)) / (2.0 * step)
        np.testing.assert_allclose(maps[:, column], difference, atol=1e-7 * np.abs(maps).max())


@pytest.mark.parametrize("seed", range(3))
def test_identities_of_the_prediction_model(seed: int) -> None:
    controller, _, state = moving_controller(np.random.default_rng(10 + seed))
    controller.solve(0, **state)
    model, measured = controller.prediction, controller.state
    wrench = np.concatenate([model.force_of_thrust @ state["thrusts"], model.moment_of_thrust @ state["thrusts"]])
    np.testing.assert_allclose(wrench, wrench_in_body(state, state["joints"]), atol=1e-9 * np.abs(wrench).max())

    def weight(rpy: np.ndarray) -> np.ndarray:
        rotation = Rotation.from_euler("ZYX", rpy[::-1]).as_matrix()
        return rotation.T @ [0.0, 0.0, -9.81 * model.mass]

    np.testing.assert_allclose(weight(measured.rpy), model.weight, atol=1e-9)
    for axis in range(3):
        shift = 1e-5 * np.eye(3)[axis]
        difference = (weight(measured.rpy + shift) - weight(measured.rpy - shift)) / 2e-5
        np.testing.assert_allclose(model.weight_per_rpy[:, axis], difference, atol=1e-7 * 9.81 * model.mass)
    # With joints at rest the momentum is that of a rigid body, so roll, pitch and yaw change as the body turns.
    state["velocity"][6:] = 0.0
    controller.solve(0, **state)
    model, measured = controller.prediction, controller.state
    np.testing.assert_allclose(measured.angular_momentum, model.inertia @ model.angular_velocity, atol=1e-13)
    ahead = Rotation.from_matrix(model.world_R_body) * Rotation.from_rotvec(1e-6 * model.angular_velocity)
    rate = (ahead.as_euler("ZYX")[::-1] - measured.rpy) / 1e-6
    np.testing.assert_allclose(model.rpy_rate @ measured.angular_momentum, rate, atol=1e-5)


def test_slopes_of_the_jets_are_derivatives() -> None:
    controller, _, state = moving_controller(np.random.default_rng(20))
    variables = controller.variables.copy()
    controller.solve(0, **state)

    def acceleration(jet: int, thrust: float, rate: float, v: float) -> float:
        T, D, m = (thrust - whole.MK3.thrust_mean) / whole.MK3.thrust_scale, rate / whole.MK3.thrust_scale, whole.MK3
        f = m.c + m.K_T * T + m.K_D * D + m.K_TD * T * D + m.K_TT * T * T + m.K_DD * D * D
        g = m.B + m.B_T * T + m.B_D * D + m.B_TD * T * D + m.B_TT * T * T + m.B_DD * D * D
        return m.thrust_scale * (f + g * v)

    for i, jet in enumerate(controller.prediction.jets):
        at = np.array([state["thrusts"][i], state["thrust_rates"][i], variables[i]])
        assert jet.constant == pytest.approx(acceleration(i, *at), rel=1e-10)
        for slope, shift in zip((jet.per_thrust, jet.per_rate, jet.per_variable), 1e-4 * np.eye(3), strict=True):
            difference = (acceleration(i, *(at + shift)) - acceleration(i, *(at - shift))) / 2e-4
            assert slope == pytest.approx(difference, rel=1e-6)


def sparse_of(controller: dyn.PredictiveController, settings: dyn.FlightSettings, variables: np.ndarray):
    """The sparse form of a solve in hover."""
    hover = whole.trim()
    com = dyn.center_of_mass(whole.robot(), hover.base_pose, hover.joints)
    chest = dyn.frame_pose(whole.robot(), hover.base_pose, hover.joints, "chest")
    rpy = Rotation.from_matrix(chest[:3, :3]).as_euler("ZYX")[::-1]
    reference = np.zeros(26)
    reference[:3], reference[6:9] = com, rpy
    references = np.tile(reference, (len(controller.step_ends), 1))
    error = np.zeros(len(whole.ARMS))
    return sparse_problem(controller, settings.predictive, variables, error, (com, rpy), references)


def test_condensed_solution_solves_the_sparse_problem() -> None:
    controller, settings, state = moving_controller(np.random.default_rng(30))
    settings.predictive = unbounded(settings.predictive)
    controller = dyn.PredictiveController(whole.robot(), settings)
    hover = whole.trim()
    controller.start(hover.base_pose, hover.joints, hover.thrusts, hover.joints)
    variables = controller.variables.copy()
    state["thrusts"], state["joints"] = hover.thrusts, hover.joints
    state["base_pose"], state["velocity"] = hover.base_pose, 0.05 * state["velocity"]
    assert controller.solve(0, **state) == dyn.QpStatus.solved
    assert not np.count_nonzero(controller.result.multipliers), "a bound is active: choose another state"
    problem = sparse_of(controller, settings, variables)
    rows = problem.A[: problem.equations]
    assert rows.shape[1] == 588
    kkt = sp.bmat([[problem.P, rows.T], [rows, None]], format="csc")
    right = np.concatenate([-problem.q, problem.lower[: problem.equations]])
    y = splu(kkt).solve(right)
    y += splu(kkt).solve(right - kkt @ y)
    x = controller.result.x
    np.testing.assert_allclose(x, y[problem.inputs], atol=1e-9 * np.abs(x).max())


def unbounded(predictive: dyn.PredictiveSettings) -> dyn.PredictiveSettings:
    predictive.joint_speed = np.inf
    return predictive


def test_what_the_model_lacks_is_named() -> None:
    settings = whole.settings()
    settings.actuators = ironcub_flight.settings().actuators
    with pytest.raises(ValueError, match="standardized turbine dynamics"):
        dyn.simulate_flight(whole.robot(), settings)
    settings = whole.settings()
    predictive = settings.predictive
    predictive.joints = [*whole.ARMS, "torso_yaw"]
    settings.predictive = predictive
    with pytest.raises(ValueError, match='"torso_yaw" moves the body "chest"'):
        dyn.simulate_flight(whole.robot(), settings)
