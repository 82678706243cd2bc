"""Third-party robots for the tests, and random states."""

import re
from dataclasses import dataclass
from importlib.metadata import files
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from codesign import dynamics as dyn


@dataclass(frozen=True)
class Robot:
    """A URDF of a PyPI package, and how to load it."""

    name: str
    kind: str
    package: str
    path: str  # end of the file's path inside the package
    as_published: bool = False

    def file(self) -> Path:
        found = [f for f in files(self.package) or [] if str(f).endswith(self.path)]
        return Path(str(found[0].locate())).resolve()

    def joints(self) -> list[str]:
        """Movable joints that do not mimic another one, in the order of the file."""
        joints = ElementTree.parse(self.file()).getroot().findall("joint")
        return [str(j.get("name")) for j in joints if j.get("type") != "fixed" and j.find("mimic") is None]

    def load(self) -> dyn.Model:
        """Joints that mimic others are locked at zero, as the references lock them."""
        text = re.sub(r"<mimic\b[^>]*/>", "", self.file().read_text())
        return dyn.load_urdf(text, self.joints(), self.as_published)


ERD, ICUB = "example-robot-data", "icub-models"
ROBOTS = [
    Robot("iCub", "humanoid", ICUB, "iCubGazeboV2_7/model.urdf"),
    Robot("iCub hand", "hand", ICUB, "left_hand_mk3/model.urdf"),
    Robot("G1", "humanoid", ERD, "g1_29dof_rev_1_0.urdf"),
    Robot("Talos", "humanoid", ERD, "talos_reduced_corrected.urdf"),
    Robot("Centauro", "wheeled centaur", ERD, "centauro.urdf"),
    Robot("Solo 12", "quadruped", ERD, "solo12.urdf"),
    Robot("Go2", "quadruped", ERD, "go2_description/urdf/go2.urdf"),
    Robot("Panda", "arm with prismatic fingers", ERD, "panda_description/urdf/panda.urdf"),
    Robot("UR5", "arm", ERD, "ur5_robot.urdf"),
    Robot("PR2", "mobile manipulator, inertias that no body can have", ERD, "pr2.urdf", as_published=True),
    Robot("Iris", "drone with rotors", ERD, "robots/iris.urdf"),
    Robot("Hector", "drone, one body", ERD, "quadrotor_base.urdf"),
    Robot("Hextilt", "drone with arm", ERD, "hextilt_flying_arm_5.urdf"),
]


@dataclass(frozen=True)
class State:
    """A state and inputs of a floating-base robot with n joints, all random."""

    base_pose: np.ndarray  # (4, 4)
    s: np.ndarray  # (n,)
    nu: np.ndarray  # (6+n,)
    nu_dot: np.ndarray  # (6+n,)
    tau: np.ndarray  # (n,)
    wrench: np.ndarray  # (6,)


def random_rotation(rng: np.random.Generator) -> np.ndarray:
    Q, R = np.linalg.qr(rng.normal(size=(3, 3)))
    Q = Q * np.sign(np.diag(R))
    return Q if np.linalg.det(Q) > 0 else -Q


def random_state(n: int, seed: int) -> State:
    rng = np.random.default_rng(seed)
    pose = np.eye(4)
    pose[:3, :3] = random_rotation(rng)
    pose[:3, 3] = rng.uniform(-2, 2, 3)
    return State(
        base_pose=pose,
        s=rng.uniform(-1.5, 1.5, n),
        nu=rng.normal(size=6 + n),
        nu_dot=3 * rng.normal(size=6 + n),
        tau=10 * rng.normal(size=n),
        wrench=20 * rng.normal(size=6),
    )
