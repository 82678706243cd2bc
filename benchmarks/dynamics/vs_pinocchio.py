"""Time of the dynamics functions against Pinocchio, both called from Python on the same 23-joint iCub and state.

Prints one table: CPU time per call, ratio, and relative difference of the results. Needs the packages pin and
icub-models, and a release build of codesign. Usage: python benchmarks/dynamics/vs_pinocchio.py [--calls 20000]
"""

import argparse
import time
from collections.abc import Callable
from importlib.metadata import files

import numpy as np
import pinocchio as pin

from codesign import dynamics as dyn

ARM = ["shoulder_pitch", "shoulder_roll", "shoulder_yaw", "elbow"]
LEG = ["hip_pitch", "hip_roll", "hip_yaw", "knee", "ankle_pitch", "ankle_roll"]
LIMBS = [f"{side}_{joint}" for group in (ARM, LEG) for side in "lr" for joint in group]
JOINTS = ["torso_pitch", "torso_roll", "torso_yaw", *LIMBS]
FRAME = "l_sole"
REPEATS = 9


def cpu_times(functions: list[Callable[[], object]], calls: int) -> list[float]:
    """Microseconds per call, the best of interleaved repeats."""
    best = [np.inf] * len(functions)
    for _ in range(REPEATS):
        for k, function in enumerate(functions):
            start = time.process_time()
            for _ in range(calls):
                function()
            best[k] = min(best[k], (time.process_time() - start) / calls * 1e6)
    return best


class State:
    """One random state of the iCub in both programs; nu = X v between their velocities."""

    def __init__(self, path: str) -> None:
        self.model = dyn.load_urdf(path, JOINTS)
        full = pin.buildModelFromUrdf(path, pin.JointModelFreeFlyer())
        locked = [full.getJointId(name) for name in full.names[2:] if name not in JOINTS]
        self.peer = pin.buildReducedModel(full, locked, pin.neutral(full))
        self.data = self.peer.createData()
        rng = np.random.default_rng(0)
        R, self.s = pin.exp3(rng.normal(size=3)), rng.uniform(-1, 1, 23)
        self.nu, self.tau = rng.normal(size=29), 10 * rng.normal(size=23)
        self.pose = np.eye(4)
        self.pose[:3, :3] = R
        self.q = pin.neutral(self.peer)
        self.q[:7] = pin.SE3ToXYZQUAT(pin.SE3(self.pose))
        self.X = np.zeros((29, 29))
        self.X[:3, :3] = self.X[3:6, 3:6] = R
        for k, name in enumerate(JOINTS):
            joint = self.peer.joints[self.peer.getJointId(name)]
            self.q[joint.idx_q] = self.s[k]
            self.X[6 + k, joint.idx_v] = 1.0
        self.v = self.X.T @ self.nu


def comparisons(a: State) -> list[tuple[str, Callable, Callable, Callable]]:
    """Name, our call, Pinocchio's call, and the conversion of its result into ours."""
    model, pose, s, nu, peer, data, q, v, X = a.model, a.pose, a.s, a.nu, a.peer, a.data, a.q, a.v, a.X
    frame, mixed = peer.getFrameId(FRAME), pin.LOCAL_WORLD_ALIGNED
    generalized = X.T @ np.r_[np.zeros(6), a.tau]
    classical = np.r_[np.cross(v[3:6], v[:3]), np.zeros(26)]  # from Pinocchio's spatial base acceleration to ours

    def full_matrix(M: np.ndarray) -> np.ndarray:
        return X @ (np.triu(M) + np.triu(M, 1).T) @ X.T

    ours: dict[str, Callable] = {
        "forward dynamics": lambda: dyn.forward_dynamics(model, pose, s, nu, a.tau),
        "mass matrix": lambda: dyn.mass_matrix(model, pose, s),
        "bias forces": lambda: dyn.bias_forces(model, pose, s, nu),
        "gravity forces": lambda: dyn.gravity_forces(model, pose, s),
        "centroidal momentum matrix": lambda: dyn.centroidal_momentum_matrix(model, pose, s),
        "center of mass": lambda: dyn.center_of_mass(model, pose, s),
        "frame Jacobian": lambda: dyn.frame_jacobian(model, pose, s, FRAME),
    }
    theirs: list[tuple[Callable, Callable]] = [
        (lambda: pin.aba(peer, data, q, v, generalized), lambda b: X @ (b + classical)),
        (lambda: pin.crba(peer, data, q), full_matrix),
        (lambda: pin.rnea(peer, data, q, v, -classical), lambda b: X @ b),
        (lambda: pin.computeGeneralizedGravity(peer, data, q), lambda g: X @ g),
        (lambda: pin.computeCentroidalMap(peer, data, q), lambda C: C @ X.T),
        (lambda: pin.centerOfMass(peer, data, q), np.asarray),
        (lambda: pin.computeFrameJacobian(peer, data, q, frame, mixed), lambda J: J @ X.T),
    ]
    return [(name, call, *pair) for (name, call), pair in zip(ours.items(), theirs, strict=True)]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--calls", type=int, default=20000)
    calls = parser.parse_args().calls
    path = next(str(f.locate()) for f in files("icub-models") or [] if str(f).endswith("iCubGazeboV2_7/model.urdf"))
    print(f"{'':28}{'codesign':>10}{'pinocchio':>11}{'ratio':>8}{'difference':>12}")
    for name, ours, theirs, convert in comparisons(State(path)):
        expected = convert(np.array(theirs()))
        difference = np.linalg.norm(ours() - expected) / np.linalg.norm(expected)
        a, b = cpu_times([ours, theirs], calls)
        print(f"{name:28}{a:7.2f} us{b:8.2f} us{a / b:8.2f}{difference:12.0e}")


if __name__ == "__main__":
    main()
