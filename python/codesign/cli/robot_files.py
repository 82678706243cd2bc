"""The folder `robot` of an export: the robot for simulators, and the flight it was judged by."""

from __future__ import annotations

import json
from collections.abc import Collection, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from codesign import dynamics as dyn
from codesign.chain.chain import build_robot
from codesign.chain.flight import find_trajectory, flight_settings
from codesign.cli.export_formats import LOG, ROBOT
from codesign.files import write_text
from codesign.parts.component import Component
from codesign.problem.design_space import value_text
from codesign.problem.evaluation import Evaluation
from codesign.robot.collisions import ignored_pairs
from codesign.robot.description import RobotDescription
from codesign.robot.jets import flying_document
from codesign.robot.mjcf import mjcf_text
from codesign.robot.package import with_obj_meshes, write_urdf_package
from codesign.robot.sdf import sdf_text
from codesign.robot.srdf import srdf_text
from codesign.storage.flight_log import flown_columns, flown_metadata, write_csv, write_parquet
from codesign.storage.flight_mcap import write_mcap
from codesign.transforms import Matrix

if TYPE_CHECKING:
    from codesign.chain.study import Study

EVERY = 25  # samples of a flight between two postures in which collision shapes may overlap


def write_robot_files(
    study: Study,
    evaluation: Evaluation,
    components: Sequence[tuple[Component, str]],
    log: dyn.FlightLog,
    formats: Collection[str],
    folder: Path,
) -> None:
    """Writes what the formats ask for.

    urdf: robot.urdf and meshes, which come with mjcf and sdf, too. mjcf: robot.xml. sdf: robot.sdf. With one of both
    robot.srdf. csv, parquet, mcap: flight.*. With all but urdf robot.json: jets, start, controller.

    components: parts in their places and the links that they are. log: of the flight that the evaluation is of.
    """
    design = study.space.design(evaluation.design)
    config = study.configured(design)
    settings = flight_settings(config.flown, find_trajectory(config, config.flown.trajectory))
    simulated, logged = ("mjcf" in formats or "sdf" in formats), any(kind in formats for kind in LOG)
    robot = build_robot(study, design)
    folder.mkdir(exist_ok=True)
    if any(kind in formats for kind in ROBOT):
        robot = write_urdf(study, robot, components, folder)
    if simulated:
        _write_models(robot, settings, log, formats, folder)
    if logged:
        words = {key: value_text(value) for key, value in design.items()}
        words = {"study": study.name, **words, "trajectory": config.flown.trajectory}
        _write_log(log, settings, robot, words, formats, folder)
    if simulated or logged:
        document = flying_document(robot, settings) | {
            "study": {"name": study.name, "title": study.title},
            "design": evaluation.design,
            "trajectory": config.flown.trajectory,
            "objectives": evaluation.objectives,
        }
        write_text(folder / "robot.json", json.dumps(document, indent=1))


def write_urdf(
    study: Study, robot: RobotDescription, components: Sequence[tuple[Component, str]], folder: Path
) -> RobotDescription:
    """Writes robot.urdf with the parts' meshes and returns it as written."""
    placements = {place.link: place for part in study.config.parts for place in part.placements}
    writers = {}
    for component, link in components:
        filename = f"{component.part.name}.stl"
        writers[filename] = component.part.write_stl
        robot = robot.set_mesh(link, filename, placements[link].link_T_part.matrix(), 1e-3)
    return RobotDescription.load(write_urdf_package(robot, folder, writers))


def flown_postures(settings: dyn.FlightSettings, log: dyn.FlightLog) -> dict[str, Matrix]:
    """Joint -> angles (n,) [rad] in postures that matter: the start, all zero, every 25th sample of the flight."""
    flown = log.joint_positions[::EVERY]
    flown = flown[np.isfinite(flown).all(axis=1)]
    postures = np.vstack([settings.initial_joints, np.zeros_like(settings.initial_joints), flown])
    return {name: postures[:, number] for number, name in enumerate(settings.joints)}


def _write_models(
    robot: RobotDescription, settings: dyn.FlightSettings, log: dyn.FlightLog, formats: Collection[str], folder: Path
) -> None:
    robot = with_obj_meshes(robot)
    ignored = ignored_pairs(robot, flown_postures(settings, log))
    write_text(folder / "robot.srdf", srdf_text(robot, settings, ignored))
    if "mjcf" in formats:
        write_text(folder / "robot.xml", mjcf_text(robot, settings, ignored))
    if "sdf" in formats:
        write_text(folder / "robot.sdf", sdf_text(robot, settings, ignored))


def _write_log(
    log: dyn.FlightLog,
    settings: dyn.FlightSettings,
    robot: RobotDescription,
    words: dict[str, str],
    formats: Collection[str],
    folder: Path,
) -> None:
    slides = [name for name in robot.moving_joint_names if robot.joint(name).type == "prismatic"]
    columns, metadata = flown_columns(log, settings, slides), flown_metadata(log, settings, words)
    if "csv" in formats:
        write_csv(columns, folder / "flight.csv")
    if "parquet" in formats:
        write_parquet(columns, folder / "flight.parquet", metadata)
    if "mcap" in formats:
        write_mcap(log, settings, robot.root_link, folder / "flight.mcap", metadata)
