"""Fly the robots of the published optimization run and compare with the published outputs.

    python benchmarks/published/flights.py [--data ../shared/data/published] [--rows 0 66 195] [--perturb 1e-15]

Every row of designs.csv is remade by the authors' rule (tests/python/published_robots.py), flown on trajectory 1 with
inertias as published, and its six `script` outputs are compared. A row is *kept* when the published flight was
completed and

- the joint-space inertia (mass matrix with the base eliminated; unphysical tensors make it indefinite) has no
  eigenvalue within 1e-6 kg m^2 of zero at any of the 5251 control steps: nearer, the published program, which forms
  the inverse, loses the digits to compare;
- no thrust reaches its limit, where the flight is chaotic.

Both are properties of our flight alone: the deviation from the published outputs does not enter. Kept rows must agree
to 1e-6, the others are listed with deviation and reason. --perturb: fly what is listed once more with the initial
joint angles changed by that relative amount, and print how far our own outputs move.
"""

import argparse
import os
import sys
import time
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import numpy as np

REPOSITORY = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(REPOSITORY / "tests" / "python"))

import ironcub_flight  # noqa: E402
import published_robots  # noqa: E402
from codesign import dynamics as dyn  # noqa: E402

TOLERANCE = 1e-6
LEAST_EIGENVALUE = 1e-6  # kg m^2
THRUST_MARGIN = 0.5  # N below the limit


@dataclass
class Comparison:
    """A row, how far its flight is from the published one, and why it is not kept."""

    row: dict[str, str]
    deviation: float  # largest of the six outputs, relative
    least_eigenvalue: float  # of the joint-space inertia, absolute value [kg m^2]
    reason: str  # why the row is not kept, or empty
    perturbed: float  # how far our outputs move under the perturbation, relative


def least_eigenvalue(model: dyn.Model, log: dyn.FlightLog) -> float:
    """Smallest absolute eigenvalue of the joint-space inertia over the flight [kg m^2]."""
    pose = np.eye(4)
    matrices = []
    for rotation, joints in zip(log.base_rotation, log.joint_positions, strict=True):
        pose[:3, :3] = rotation
        M = dyn.mass_matrix(model, pose, joints)
        matrices.append(M[6:, 6:] - M[6:, :6] @ np.linalg.solve(M[:6, :6], M[:6, 6:]))
    return float(np.abs(np.linalg.eigvalsh(np.array(matrices))).min())


def reason_to_drop(row: dict[str, str], log: dyn.FlightLog, least: float, thrust_max: float) -> str:
    """Why the row is not kept, or an empty text."""
    if row["qp_status"] != "0":
        return "published flight not completed"
    if not log.completed:
        return f"our flight lost: {log.failure_reason}"
    if log.max_thrust > thrust_max - THRUST_MARGIN:
        return "thrust at its limit"
    return "mass matrix near-singular" if least < LEAST_EIGENVALUE else ""


def deviation(outputs: np.ndarray, expected: np.ndarray) -> float:
    return float(np.abs(outputs / expected - 1.0).max())


def compare(row: dict[str, str], model: dyn.Model, perturb: float) -> tuple[Comparison, float]:
    """The row's comparison, and the CPU time of its flight [s]."""
    settings = ironcub_flight.settings(1)
    settings.rotation_deadband = 1e-6
    start = time.process_time()
    log = dyn.simulate_flight(model, settings)
    seconds = time.process_time() - start
    outputs = published_robots.flown_outputs(log)
    least = least_eigenvalue(model, log)
    reason = reason_to_drop(row, log, least, settings.actuators[0].thrust_max)
    found = Comparison(row, deviation(outputs, published_robots.published_outputs(row)), least, reason, 0.0)
    if perturb and row["qp_status"] == "0" and (reason or found.deviation > TOLERANCE):
        rng = np.random.default_rng(0)
        settings.initial_joints = settings.initial_joints * (1.0 + perturb * rng.standard_normal(len(settings.joints)))
        moved = published_robots.flown_outputs(dyn.simulate_flight(model, settings))
        found.perturbed = deviation(moved, outputs)
    return found, seconds


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    shared = Path(os.environ.get("CODESIGN_SHARED", REPOSITORY.parent / "shared"))
    parser.add_argument("--data", type=Path, default=shared / "data" / "published")
    parser.add_argument("--rows", nargs="*", help="ids; default: all")
    parser.add_argument("--perturb", type=float, default=0.0)
    options = parser.parse_args()
    rows = published_robots.read_rows(options.data / "designs.csv")
    rows = [row for row in rows if not options.rows or row["id"] in options.rows]
    optim1 = (options.data / "optim1.urdf").read_text()
    found: list[Comparison] = []
    seconds = 0.0
    for row in rows:
        urdf = published_robots.published_robot(optim1, row)
        model = dyn.load_urdf(urdf, joints=ironcub_flight.JOINTS, as_published=True)
        comparison, flight = compare(row, model, options.perturb)
        found.append(comparison)
        seconds += flight
    print("  id length angle deviation  |eigenvalue|  perturbed  reason")
    for c in sorted(found, key=lambda c: (c.reason, c.deviation)):
        if c.reason or c.deviation > TOLERANCE:
            print(
                f"{c.row['id']:>4} {c.row['length_mm']:>6} {c.row['angle_paper_deg']:>5} {c.deviation:9.1e}"
                f" {c.least_eigenvalue:13.1e} {c.perturbed:10.1e}  {c.reason}"
            )
    for reason, count in Counter(c.reason or "kept" for c in found).items():
        deviations = np.array([c.deviation for c in found if (c.reason or "kept") == reason])
        print(f"{reason}: {count} rows, {(deviations <= TOLERANCE).sum()} within 1e-6, largest {deviations.max():.1e}")
    print(f"{len(found)} rows; {seconds / len(found):.3f} s of CPU per flight")
    return int(any(c.deviation > TOLERANCE for c in found if not c.reason))


if __name__ == "__main__":
    sys.exit(main())
