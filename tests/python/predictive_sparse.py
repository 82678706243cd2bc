"""The predictive controller's problem with its states as unknowns, built from the model that the controller shows."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from codesign import dynamics as dyn


@dataclass
class SparseProblem:
    """min 1/2 y'Py + q'y, rows: lower <= A y <= upper; y = (z_0 … z_N, joint blocks, throttle blocks).

    inputs: where each of the condensed problem's unknowns stands in y.
    """

    P: sp.csc_matrix
    q: np.ndarray
    A: sp.csc_matrix
    lower: np.ndarray
    upper: np.ndarray
    inputs: np.ndarray
    equations: int


def skew(v: np.ndarray) -> np.ndarray:
    """S(v) with S(v) x = v × x."""
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def continuous(model: dyn.PredictionModel, com: np.ndarray, rpy: np.ndarray) -> tuple[np.ndarray, ...]:
    """z' = A z + B_s Δs + B_v v + d; integrals of errors from (com, rpy)."""
    jets, joints = len(model.jets), model.force_of_joint.shape[1]
    n = 18 + 2 * jets
    A, B_s, B_v, d = np.zeros((n, n)), np.zeros((n, joints)), np.zeros((n, jets)), np.zeros(n)
    thrust, rate = slice(12, 12 + jets), slice(12 + jets, 12 + 2 * jets)
    A[0:3, 3:6] = model.world_R_body / model.mass
    A[3:6, 3:6] = A[9:12, 9:12] = -skew(model.angular_velocity)
    A[3:6, thrust], A[9:12, thrust] = model.force_of_thrust, model.moment_of_thrust
    A[3:6, 6:9] = model.weight_per_rpy
    d[3:6] = model.weight - model.weight_per_rpy @ model.rpy
    A[6:9, 9:12] = model.rpy_rate
    B_s[3:6], B_s[9:12] = model.force_of_joint, model.moment_of_joint
    A[thrust, rate] = np.eye(jets)
    for i, jet in enumerate(model.jets):
        row = 12 + jets + i
        A[row, 12 + i], A[row, row], B_v[row, i] = jet.per_thrust, jet.per_rate, jet.per_variable
        d[row] = (
            jet.constant
            - jet.per_thrust * jet.thrust
            - jet.per_rate * jet.thrust_rate
            - jet.per_variable * jet.variable
        )
    A[n - 6 : n - 3, 0:3] = A[n - 3 :, 6:9] = np.eye(3)
    d[n - 6 : n - 3], d[n - 3 :] = -com, -rpy
    return A, B_s, B_v, d


def weights_of(weights: dyn.PredictiveWeights, jets: int) -> np.ndarray:
    """Diagonal of the states' weights."""
    none = np.zeros(2 * jets)
    rows = (weights.com, weights.linear_momentum, weights.attitude, weights.angular_momentum, none)
    return np.concatenate([*rows, weights.com_integral, weights.attitude_integral])


def structure(jets: int) -> np.ndarray:
    """Which entries of 1 + h A can be other than zero; kept though they are, so that all problems are alike."""
    kept = np.eye(18 + 2 * jets, dtype=bool)
    vectors = {
        "com": 0,
        "linear": 3,
        "rpy": 6,
        "angular": 9,
        "com_integral": 12 + 2 * jets,
        "rpy_integral": 15 + 2 * jets,
    }
    for to, of in (
        ("com", "linear"),
        ("linear", "linear"),
        ("linear", "rpy"),
        ("rpy", "angular"),
        ("angular", "angular"),
    ):
        kept[vectors[to] : vectors[to] + 3, vectors[of] : vectors[of] + 3] = True
    for to in (3, 9):
        kept[to : to + 3, 12 : 12 + jets] = True
    for i in range(jets):
        kept[12 + i, 12 + jets + i] = kept[12 + jets + i, 12 + i] = True
    for i in range(3):
        kept[vectors["com_integral"] + i, i] = kept[vectors["rpy_integral"] + i, 6 + i] = True
    return kept


class Entries:
    """Entries of a sparse matrix, block by block."""

    def __init__(self) -> None:
        self.rows: list[np.ndarray] = []
        self.columns: list[np.ndarray] = []
        self.values: list[np.ndarray] = []

    def add(self, row: int, column: int, block: np.ndarray, kept: np.ndarray | None = None) -> None:
        """A block with its first entry at (row, column); kept: entries that stand though they are zero."""
        i, j = np.nonzero(block if kept is None else kept)
        self.rows.append(row + i)
        self.columns.append(column + j)
        self.values.append(block[i, j])

    def matrix(self, shape: tuple[int, int]) -> sp.csc_matrix:
        """The matrix of all entries."""
        places = (np.concatenate(self.rows), np.concatenate(self.columns))
        return sp.csc_matrix((np.concatenate(self.values), places), shape=shape)


def cost(
    settings: dyn.PredictiveSettings,
    variables: np.ndarray,
    posture_error: np.ndarray,
    references: np.ndarray,
    blocks: tuple[int, int],
) -> tuple[sp.csc_matrix, np.ndarray]:
    """Quadratic and linear part; arguments as of `sparse_problem`; blocks: of joints and of throttles."""
    weights, (steps, n) = settings.weights, references.shape
    jets, joints = len(variables), len(posture_error)
    first_joint = (steps + 1) * n
    first_throttle = first_joint + blocks[0] * joints
    size = first_throttle + blocks[1] * jets
    diagonal, q = np.zeros(size), np.zeros(size)
    Q = weights_of(weights, jets)
    diagonal[n:first_joint] = np.tile(Q, steps)
    q[n:first_joint] = -(Q * references).ravel()
    diagonal[first_joint:first_throttle] = weights.joint_displacement + weights.posture
    q[first_joint:first_throttle] = np.tile(weights.posture * posture_error, blocks[0])
    P = sp.lil_matrix(sp.diags(diagonal))
    for block in range(blocks[1]):
        for i in range(jets):
            at = first_throttle + block * jets + i
            if block == 0:
                P[at, at] += weights.throttle_first
                q[at] = -weights.throttle_first * variables[i]
                continue
            P[at, at] += weights.throttle_change
            P[at - jets, at - jets] += weights.throttle_change
            P[at, at - jets] = P[at - jets, at] = -weights.throttle_change
    return sp.csc_matrix(P), q


def sparse_problem(
    controller: dyn.PredictiveController,
    settings: dyn.PredictiveSettings,
    variables: np.ndarray,
    posture_error: np.ndarray,
    now: tuple[np.ndarray, np.ndarray],
    references: np.ndarray,
) -> SparseProblem:
    """The problem of the controller's last solve.

    variables (jets,): of the throttles before it. posture_error (joints,): set points less home. now: references of
    center of mass and attitude at the solve. references (N, n): of the states at the end of each step.
    """
    model, state = controller.prediction, controller.state
    jets, joints = len(model.jets), model.force_of_joint.shape[1]
    A, B_s, B_v, d = continuous(model, *now)
    n, ends = len(d), np.array(controller.step_ends)
    steps, lengths = len(ends), np.diff(ends, prepend=0.0)
    blocks = settings.control_steps
    throttles = settings.control_steps - settings.small_steps + 1
    first_joint, first_throttle = (steps + 1) * n, (steps + 1) * n + blocks * joints
    size = first_throttle + throttles * jets
    rows, right = Entries(), np.zeros(first_joint)
    rows.add(0, 0, np.eye(n))
    momenta = (state.com, state.linear_momentum, state.rpy, state.angular_momentum)
    right[:n] = np.concatenate(
        [*momenta, state.thrust, state.thrust_rate, state.com_integral, state.rpy_integral],
    )
    kept = structure(jets)
    for k, h in enumerate(lengths):
        at = (k + 1) * n
        joint = first_joint + joints * min(k, blocks - 1)
        throttle = first_throttle + jets * int(np.clip(k - settings.small_steps + 1, 0, throttles - 1))
        rows.add(at, at, np.eye(n))
        rows.add(at, k * n, -(np.eye(n) + h * A), kept)
        rows.add(at, joint, -h * B_s)
        rows.add(at, throttle, -h * B_v)
        right[at : at + n] = h * d
    P, q = cost(settings, variables, posture_error, references, (blocks, throttles))
    inputs = np.empty(blocks * joints + throttles * jets, dtype=int)
    for block, column in enumerate(controller.joint_columns):
        inputs[column : column + joints] = first_joint + block * joints + np.arange(joints)
    for block, column in enumerate(controller.throttle_columns):
        inputs[column : column + jets] = first_throttle + block * jets + np.arange(jets)
    for row, column in enumerate(inputs):
        rows.add(first_joint + row, column, np.eye(1))
    return SparseProblem(
        P=P,
        q=q,
        A=rows.matrix((first_joint + len(inputs), size)),
        lower=np.concatenate([right, controller.lower]),
        upper=np.concatenate([right, controller.upper]),
        inputs=inputs,
        equations=len(right),
    )
