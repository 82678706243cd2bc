"""Every quantity of codesign.dynamics against Pinocchio and against iDynTree, on third-party robots."""

from collections.abc import Callable

import numpy as np
import pinocchio as pin
import pytest
from idyntree import bindings as idt

from codesign import dynamics as dyn
from robots import ROBOTS, Robot, State, random_state

TOLERANCE = 1e-9  # relative; double precision leaves about 1e-13, forward dynamics of light bodies 1e-11
STATES = range(3)


class PinocchioReference:
    """The same quantities from Pinocchio, brought into mixed coordinates and our joint order."""

    def __init__(self, robot: Robot, joints: list[str]):
        full = pin.buildModelFromUrdf(str(robot.file()), pin.JointModelFreeFlyer())
        locked = [full.getJointId(name) for name in full.names[2:] if name not in joints]
        self.model = pin.buildReducedModel(full, locked, pin.neutral(full))
        self.model.gravity.linear = np.array([0.0, 0.0, -9.81])
        self.data = self.model.createData()
        self.joints = [self.model.joints[self.model.getJointId(name)] for name in joints]

    def set_state(self, state: State) -> None:
        R = state.base_pose[:3, :3]
        self.q = pin.neutral(self.model)
        self.q[:7] = pin.SE3ToXYZQUAT(pin.SE3(state.base_pose))
        # nu = X v: v has the base velocity in body axes and Pinocchio's joint order.
        self.X = np.zeros((self.model.nv, self.model.nv))
        self.X[:3, :3] = self.X[3:6, 3:6] = R
        for k, joint in enumerate(self.joints):
            position = state.s[k]
            unbounded = joint.nq == 2
            self.q[joint.idx_q : joint.idx_q + joint.nq] = (
                [np.cos(position), np.sin(position)] if unbounded else [position]
            )
            self.X[6 + k, joint.idx_v] = 1.0
        self.v = self.X.T @ state.nu

    def acceleration(self, nu_dot: np.ndarray) -> np.ndarray:
        a = self.X.T @ nu_dot
        a[:3] -= np.cross(self.v[3:6], self.v[:3])
        return a

    def nu_dot(self, a: np.ndarray) -> np.ndarray:
        a = a.copy()
        a[:3] += np.cross(self.v[3:6], self.v[:3])
        return self.X @ a

    def mass_matrix(self) -> np.ndarray:
        M = pin.crba(self.model, self.data, self.q)
        M = np.triu(M) + np.triu(M, 1).T
        return self.X @ M @ self.X.T

    def inverse_dynamics(self, nu_dot: np.ndarray) -> np.ndarray:
        return self.X @ pin.rnea(self.model, self.data, self.q, self.v, self.acceleration(nu_dot))

    def gravity_forces(self) -> np.ndarray:
        return self.X @ pin.computeGeneralizedGravity(self.model, self.data, self.q)

    def forward_dynamics(self, tau: np.ndarray, frame: str, wrench: np.ndarray) -> np.ndarray:
        forces = pin.StdVec_Force()
        for _ in range(self.model.njoints):
            forces.append(pin.Force.Zero())
        index = self.model.getFrameId(frame)
        placement = self.pose(frame)
        at_frame = pin.Force(placement.rotation.T @ wrench[:3], placement.rotation.T @ wrench[3:])
        joint = self.model.frames[index].parentJoint
        forces[joint] = self.model.frames[index].placement.act(at_frame)
        generalized = self.X.T @ np.r_[np.zeros(6), tau]
        return self.nu_dot(pin.aba(self.model, self.data, self.q, self.v, generalized, forces))

    def pose(self, frame: str) -> "pin.SE3":
        pin.framesForwardKinematics(self.model, self.data, self.q)
        return self.data.oMf[self.model.getFrameId(frame)]

    def frame(self, frame: str) -> dict[str, np.ndarray]:
        index, mixed = self.model.getFrameId(frame), pin.LOCAL_WORLD_ALIGNED
        J = pin.computeFrameJacobian(self.model, self.data, self.q, index, mixed)
        pin.forwardKinematics(self.model, self.data, self.q, self.v, self.acceleration(np.zeros_like(self.v)))
        return {
            "frame_pose": self.pose(frame).homogeneous,
            "frame_jacobian": J @ self.X.T,
            "frame_velocity": pin.getFrameVelocity(self.model, self.data, index, mixed).vector,
            "frame_bias_acceleration": pin.getFrameClassicalAcceleration(self.model, self.data, index, mixed).vector,
        }

    def whole(self) -> dict[str, np.ndarray]:
        pin.dccrba(self.model, self.data, self.q, self.v)
        rate = self.data.dAg @ self.v + self.data.Ag @ self.acceleration(np.zeros_like(self.v))
        pin.ccrba(self.model, self.data, self.q, self.v)
        found = {
            "centroidal_momentum": self.data.hg.vector.copy(),
            "centroidal_momentum_matrix": self.data.Ag @ self.X.T,
            "centroidal_momentum_bias": rate,
            "locked_inertia": self.data.Ig.inertia.copy(),
            "center_of_mass_jacobian": pin.jacobianCenterOfMass(self.model, self.data, self.q) @ self.X.T,
        }
        pin.centerOfMass(self.model, self.data, self.q, self.v)
        return found | {
            "center_of_mass": self.data.com[0].copy(),
            "center_of_mass_velocity": self.data.vcom[0].copy(),
            "kinetic_energy": np.array(pin.computeKineticEnergy(self.model, self.data, self.q, self.v)),
            "potential_energy": np.array(pin.computePotentialEnergy(self.model, self.data, self.q)),
        }


class IDynTreeReference:
    """The same quantities from iDynTree, whose default convention is ours."""

    def __init__(self, robot: Robot, joints: list[str], base: str):
        loader = idt.ModelLoader()
        if joints:
            assert loader.loadReducedModelFromFile(str(robot.file()), joints)
        else:
            assert loader.loadModelFromFile(str(robot.file()))
        self.kd = idt.KinDynComputations()
        assert self.kd.loadRobotModel(loader.model())
        self.n = len(joints)
        # It makes a massless root a frame of the child: the base is then that child.
        self.base = base if self.kd.setFloatingBase(base) else self.kd.getFloatingBase()

    def set_state(self, base_pose: np.ndarray, state: State) -> None:
        """base_pose: of iDynTree's base, fixed to ours. nu' = B nu for its velocity."""
        offset = base_pose[:3, 3] - state.base_pose[:3, 3]
        x, y, z = offset
        self.B = np.eye(6 + self.n)
        self.B[:3, 3:6] = [[0, z, -y], [-z, 0, x], [y, -x, 0]]
        omega = state.nu[3:6]
        self.B_rate_nu = np.zeros(6 + self.n)
        self.B_rate_nu[:3] = np.cross(omega, np.cross(omega, offset))
        gravity = np.array([0.0, 0.0, -9.81])
        nu = self.B @ state.nu
        assert self.kd.setRobotState(base_pose, state.s, nu[:6], nu[6:], gravity)

    def matrix(self, rows: int, fill: Callable[[object], bool]) -> np.ndarray:
        matrix = idt.MatrixDynSize(rows, 6 + self.n)
        assert fill(matrix)
        return matrix.toNumPy()

    def generalized(self, fill: Callable[[object], bool]) -> np.ndarray:
        forces = idt.FreeFloatingGeneralizedTorques(self.kd.model())
        assert fill(forces)
        return self.B.T @ np.r_[forces.baseWrench().toNumPy(), forces.jointTorques().toNumPy()]

    def gravity_forces(self) -> np.ndarray:
        return self.generalized(self.kd.generalizedGravityForces)

    def bias_forces(self) -> np.ndarray:
        M = self.matrix(6 + self.n, self.kd.getFreeFloatingMassMatrix)
        return self.generalized(self.kd.generalizedBiasForces) + self.B.T @ M @ self.B_rate_nu

    def inverse_dynamics(self, nu_dot: np.ndarray) -> np.ndarray:
        own = self.B @ nu_dot + self.B_rate_nu
        external = idt.LinkWrenches(self.kd.model())
        external.zero()
        base, joints = idt.Vector6.FromPython(own[:6].tolist()), idt.VectorDynSize.FromPython(own[6:].tolist())
        return self.generalized(lambda forces: self.kd.inverseDynamics(base, joints, external, forces))

    def frame(self, frame: str) -> dict[str, np.ndarray]:
        J = self.matrix(6, lambda J: self.kd.getFrameFreeFloatingJacobian(frame, J))
        return {
            "frame_pose": self.kd.getWorldTransform(frame).asHomogeneousTransform().toNumPy(),
            "frame_jacobian": J @ self.B,
            "frame_velocity": self.kd.getFrameVel(frame).toNumPy(),
            "frame_bias_acceleration": self.kd.getFrameBiasAcc(frame).toNumPy() + J @ self.B_rate_nu,
        }

    def whole(self) -> dict[str, np.ndarray]:
        B = self.B
        return {
            "mass_matrix": B.T @ self.matrix(6 + self.n, self.kd.getFreeFloatingMassMatrix) @ B,
            "center_of_mass": self.kd.getCenterOfMassPosition().toNumPy(),
            "center_of_mass_velocity": self.kd.getCenterOfMassVelocity().toNumPy(),
            "center_of_mass_jacobian": self.matrix(3, self.kd.getCenterOfMassJacobian) @ B,
            "centroidal_momentum": self.kd.getCentroidalTotalMomentum().toNumPy(),
            "centroidal_momentum_matrix": self.matrix(6, self.kd.getCentroidalTotalMomentumJacobian) @ B,
            "locked_inertia": self.kd.getCentroidalRobotLockedInertia().asMatrix().toNumPy()[3:, 3:],
        }


def ours(model: dyn.Model, state: State, name: str) -> np.ndarray:
    x = (model, state.base_pose, state.s)
    needs_velocity = ("bias", "velocity", "momentum", "kinetic_energy")
    positional = name.endswith(("matrix", "jacobian"))
    if not positional and any(word in name for word in needs_velocity):
        x = (*x, state.nu)
    return np.asarray(getattr(dyn, name)(*x))


def assert_close(found: np.ndarray, expected: np.ndarray, name: str) -> None:
    scale = max(float(np.linalg.norm(expected)), 1e-3)
    error = float(np.linalg.norm(found - expected)) / scale
    assert error < TOLERANCE, f"{name}: relative error {error:.1e}"


def some_frames(model: dyn.Model) -> list[str]:
    names = model.frame_names
    return [model.base_link, names[len(names) // 2], names[-1]]


@pytest.fixture(scope="module", params=ROBOTS, ids=lambda robot: robot.name)
def robot(request: pytest.FixtureRequest) -> Robot:
    return request.param


@pytest.fixture(scope="module")
def model(robot: Robot) -> dyn.Model:
    return robot.load()


@pytest.fixture(scope="module")
def pinocchio(robot: Robot, model: dyn.Model) -> PinocchioReference:
    return PinocchioReference(robot, model.joint_names)


@pytest.fixture(scope="module")
def idyntree(robot: Robot, model: dyn.Model) -> IDynTreeReference:
    return IDynTreeReference(robot, model.joint_names, model.base_link)


@pytest.mark.parametrize("seed", STATES)
def test_against_pinocchio(model: dyn.Model, pinocchio: PinocchioReference, seed: int) -> None:
    state = random_state(len(model.joint_names), seed)
    pinocchio.set_state(state)
    x = (model, state.base_pose, state.s)
    zero = np.zeros_like(state.nu)
    M = pinocchio.mass_matrix()
    assert_close(dyn.mass_matrix(*x), M, "mass_matrix")
    # Entry by entry too, in the scale of its row and column.
    scale = np.sqrt(np.abs(np.outer(np.diag(M), np.diag(M))))
    assert np.max(np.abs(dyn.mass_matrix(*x) - M) / scale) < TOLERANCE
    assert_close(dyn.bias_forces(*x, state.nu), pinocchio.inverse_dynamics(zero), "bias_forces")
    assert_close(
        dyn.inverse_dynamics(*x, state.nu, state.nu_dot), pinocchio.inverse_dynamics(state.nu_dot), "inverse_dynamics"
    )
    assert_close(dyn.gravity_forces(*x), pinocchio.gravity_forces(), "gravity_forces")
    for name, expected in pinocchio.whole().items():
        assert_close(ours(model, state, name), expected, name)
    for frame in some_frames(model):
        for name, expected in pinocchio.frame(frame).items():
            x_frame = (*x, state.nu) if name in ("frame_velocity", "frame_bias_acceleration") else x
            assert_close(getattr(dyn, name)(*x_frame, frame), expected, f"{name} of {frame}")
        found = dyn.forward_dynamics(*x, state.nu, state.tau, {frame: state.wrench})
        assert_close(found, pinocchio.forward_dynamics(state.tau, frame, state.wrench), f"forward_dynamics, {frame}")


@pytest.mark.parametrize("seed", STATES)
def test_against_idyntree(model: dyn.Model, idyntree: IDynTreeReference, seed: int) -> None:
    state = random_state(len(model.joint_names), seed)
    x = (model, state.base_pose, state.s)
    idyntree.set_state(dyn.frame_pose(*x, idyntree.base), state)
    assert_close(dyn.bias_forces(*x, state.nu), idyntree.bias_forces(), "bias_forces")
    assert_close(dyn.gravity_forces(*x), idyntree.gravity_forces(), "gravity_forces")
    assert_close(
        dyn.inverse_dynamics(*x, state.nu, state.nu_dot), idyntree.inverse_dynamics(state.nu_dot), "inverse_dynamics"
    )
    for name, expected in idyntree.whole().items():
        assert_close(ours(model, state, name), expected, name)
    for frame in some_frames(model):
        for name, expected in idyntree.frame(frame).items():
            x_frame = (*x, state.nu) if name in ("frame_velocity", "frame_bias_acceleration") else x
            assert_close(getattr(dyn, name)(*x_frame, frame), expected, f"{name} of {frame}")


@pytest.mark.parametrize("robot", [one for one in ROBOTS if one.name in ("Panda", "PR2")], ids=str)
def test_mimic_joints_move_along_as_in_pinocchio(robot: Robot) -> None:
    """The fingers of a hand; mass matrix and bias of a fixed base, and forward dynamics as their inverse."""
    model = dyn.load_urdf(robot.file(), as_published=robot.as_published, fixed_base=True)
    other = pin.buildModelFromUrdf(str(robot.file()), mimic=True)
    data, rng = other.createData(), np.random.default_rng(1)
    joints = [other.joints[other.getJointId(name)] for name in model.joint_names]
    assert sum(joint.nv for joint in joints) == other.nv == len(joints)
    order = [joint.idx_v for joint in joints]
    for _ in STATES:
        s, nu, tau = rng.uniform(-1, 1, (3, len(joints)))
        q, v = pin.neutral(other), np.zeros(other.nv)
        v[order] = nu
        for k, joint in enumerate(joints):
            angle = [np.cos(s[k]), np.sin(s[k])] if joint.nq == 2 else [s[k]]
            q[joint.idx_q : joint.idx_q + joint.nq] = angle
        M = pin.crba(other, data, q)
        M = (np.triu(M) + np.triu(M, 1).T)[np.ix_(order, order)]
        bias = pin.rnea(other, data, q, v, np.zeros(other.nv))[order]
        np.testing.assert_allclose(dyn.mass_matrix(model, np.eye(4), s), M, atol=TOLERANCE * np.abs(M).max())
        found = dyn.bias_forces(model, np.eye(4), s, nu)
        np.testing.assert_allclose(found, bias, atol=TOLERANCE * np.abs(bias).max())
        nu_dot = dyn.forward_dynamics(model, np.eye(4), s, nu, tau)
        np.testing.assert_allclose(dyn.inverse_dynamics(model, np.eye(4), s, nu, nu_dot), tau, atol=1e-8)
