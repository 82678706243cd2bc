"""Robots of designs written as `codesign export --formats mjcf,sdf` does, without the chain."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from codesign import dynamics as dyn
from codesign.chain.chain import build_parts, build_robot
from codesign.chain.flight import find_trajectory, flight_settings
from codesign.chain.study import load_study
from codesign.cli.export.design import placed_components
from codesign.cli.export.robot_files import flown_postures, write_urdf
from codesign.robot.collisions import ignored_pairs
from codesign.robot.description import RobotDescription
from codesign.robot.formats.drake_filters import NAMESPACE, urdf_collision_filters
from codesign.robot.formats.mjcf import mjcf_text
from codesign.robot.formats.sdf import sdf_text
from codesign.robot.formats.srdf import srdf_text
from codesign.robot.package import with_obj_meshes

ORIGINAL = {
    "ironcub_paper": {"angle": 15, "distance": 42, "offset": 80, "length": 108},
    "gimbal_quad": {"reach": 200, "height": 30},
}


@dataclass(frozen=True)
class Exported:
    """Files of a robot in a folder, and the flight they are of."""

    folder: Path
    robot: RobotDescription
    settings: dyn.FlightSettings
    ignored: dict[tuple[str, str], str]
    log: dyn.FlightLog

    @property
    def joints(self) -> list[str]:
        """All joints that move, in the URDF's order."""
        return list(self.robot.moving_joint_names)


def random_design(study: str, seed: int) -> dict[str, float]:
    rng = np.random.default_rng(seed)
    return {v.name: v.value(int(rng.integers(v.levels))) for v in load_study(study).space.variables}


def export_robot(study_name: str, theta: dict[str, float], folder: Path, duration: float = 3.0) -> Exported:
    """The flight is integrated by Runge-Kutta at 1 ms, so that others can step through it."""
    study = load_study(study_name)
    design = study.space.design(theta)
    config = study.configured(design)
    settings = flight_settings(config.flight, find_trajectory(config, config.flight.trajectory))
    settings.integrator, settings.substeps, settings.duration = dyn.Integrator.runge_kutta_4, 8, duration
    settings.rotation_deadband = 0.0
    components = placed_components(study, design, build_parts(study, design))
    written = write_urdf(study, build_robot(study, design), components, folder, settings.limits)
    robot = with_obj_meshes(written)
    log = dyn.simulate_flight(dyn.load_urdf(robot.to_text(), joints=settings.joints), settings)
    ignored = ignored_pairs(robot, flown_postures(settings, log))
    written.with_elements(urdf_collision_filters(ignored), NAMESPACE).write(folder / "robot.urdf")
    for name, text in (("xml", mjcf_text), ("sdf", sdf_text), ("srdf", srdf_text)):
        (folder / f"robot.{name}").write_text(text(robot, settings, ignored))
    return Exported(folder, robot, settings, ignored, log)
