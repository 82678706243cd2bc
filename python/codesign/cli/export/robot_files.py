"""The folder `robot` of an export: the robot for simulators, and the flight it was judged by."""

from __future__ import annotations

import json
from collections.abc import Collection, Sequence
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import manifold3d
import numpy as np

from codesign import dynamics as dyn
from codesign.chain.chain import build_robot
from codesign.chain.clearances import part_pieces
from codesign.chain.flight import find_trajectory, flight_settings
from codesign.cli.export.formats import LOG, ROBOT
from codesign.files import write_text
from codesign.geometry.mesh_files import obj_text
from codesign.names import identifier
from codesign.parts.component import Component
from codesign.parts.part import EXPORT_RESOLUTION, Part
from codesign.problem.design_space import Design, value_text
from codesign.problem.evaluation import Evaluation
from codesign.robot.clearance import SLICES
from codesign.robot.collisions import ignored_pairs
from codesign.robot.description import RobotDescription
from codesign.robot.formats.drake_filters import NAMESPACE, urdf_collision_filters
from codesign.robot.formats.mjcf import mjcf_text
from codesign.robot.formats.ros2 import RosPackage, ros_name, write_ros2_package
from codesign.robot.formats.sdf import sdf_text
from codesign.robot.formats.simplified import Simplification, simplified, with_tiny_inertials
from codesign.robot.formats.srdf import srdf_text
from codesign.robot.jets import flying_document
from codesign.robot.package import MeshWriter, with_obj_meshes, write_urdf_package
from codesign.storage.flight_log import flown_columns, flown_metadata, write_csv, write_parquet
from codesign.storage.flight_mcap import write_mcap
from codesign.transforms import Matrix
from codesign.units import MILLIMETER

if TYPE_CHECKING:
    from codesign.chain.study import Study

BOUNDS = " effort and velocity of joints are at most the bounds of the study's controller: robot.json "
AS_FLOWN = Simplification()
EVERY = 25  # samples of a flight between two postures in which collision shapes may overlap


def write_robot_files(
    study: Study,
    evaluation: Evaluation,
    components: Sequence[tuple[Component, str]],
    log: dyn.FlightLog,
    formats: Collection[str],
    folder: Path,
    how: Simplification = AS_FLOWN,
) -> None:
    """Writes what the formats ask for.

    urdf: robot.urdf, robot.srdf and meshes, which come with mjcf, sdf and ros2, too. mjcf: robot.xml. sdf: robot.sdf.
    csv, parquet, mcap: flight.*. With each robot.json: jets, start, controller. ros2: a package in the folder `ros2`
    beside.

    components: parts in their places and the links that they are. log: of the flight that the evaluation is of. how:
    what is written differently from the robot that was flown.
    """
    design = study.space.design(evaluation.design)
    config = study.configured(design)
    settings = flight_settings(config.flown, find_trajectory(config, config.flown.trajectory))
    momentum_qp = settings.controller == dyn.Controller.momentum_qp
    robot = build_robot(study, design)
    settings = dyn.fitted_settings(dyn.load_urdf(robot.to_text(), joints=settings.joints), settings)
    folder.mkdir(exist_ok=True)
    if any(kind in formats for kind in ROBOT):
        robot = write_urdf(study, robot, components, folder, settings.limits if momentum_qp else None)
        package = RosPackage(ros_name(f"{study.name}_description"), _title(study, design), _values(study, design))
        _write_models(robot, settings, log, formats, folder, package, how)
    if any(kind in formats for kind in LOG):
        words = {key: value_text(value) for key, value in design.items()}
        words = {"study": study.name, **words, "trajectory": config.flown.trajectory}
        _write_log(log, settings, robot, words, formats, folder)
    document = flying_document(robot, settings) | {
        "study": {"name": study.name, "title": study.title},
        "design": evaluation.design,
        "trajectory": config.flown.trajectory,
        "objectives": evaluation.objectives,
        "robot_files": asdict(how),
    }
    write_text(folder / "robot.json", json.dumps(document, indent=1))


def write_urdf(
    study: Study,
    robot: RobotDescription,
    components: Sequence[tuple[Component, str]],
    folder: Path,
    limits: dyn.Limits | None = None,
) -> RobotDescription:
    """Writes robot.urdf with the parts' meshes and returns it as written.

    Parts collide as the convex pieces with which clearances are computed, in OBJ files, which every reader takes. The
    robot's name becomes an identifier, as USD wants it.

    limits: of the flight; effort and velocity of the joints are bounded by them.
    """
    placements = {place.link: place for part in study.config.parts for place in part.placements}
    slices = SLICES if study.config.interference is None else study.config.interference.slices
    writers: dict[str, MeshWriter] = {}
    for component, link in components:
        part = component.part
        filename = f"{part.name}.obj"
        writers[filename] = partial(_write_part, part)
        pieces = {
            f"{part.name}_collision_{number}.obj": points
            for number, points in enumerate(part_pieces(part, slices), start=1)
        }
        writers |= {name: partial(_write_piece, points) for name, points in pieces.items()}
        pose = placements[link].link_T_part.matrix()
        robot = robot.set_mesh(link, filename, pose, MILLIMETER, collisions=list(pieces))
    if limits is not None:
        robot = robot.with_joint_bounds(limits.torque, limits.joint_speed)
    return RobotDescription.load(write_urdf_package(robot.renamed(identifier(robot.name)), folder, writers))


def _write_part(part: Part, path: Path) -> None:
    solid = part.solid(EXPORT_RESOLUTION)
    write_text(path, obj_text(solid.points, solid.triangles))


def _write_piece(points: Matrix, path: Path) -> None:
    """The convex hull of points [m], in mm."""
    mesh = manifold3d.Manifold.hull_points(points / MILLIMETER).to_mesh()
    write_text(path, obj_text(mesh.vert_properties, mesh.tri_verts))


def flown_postures(settings: dyn.FlightSettings, log: dyn.FlightLog) -> dict[str, Matrix]:
    """Joint -> angles (n,) [rad] in postures that matter: the start, all zero, every 25th sample of the flight."""
    flown = log.joint_positions[::EVERY]
    flown = flown[np.isfinite(flown).all(axis=1)]
    postures = np.vstack([settings.initial_joints, np.zeros_like(settings.initial_joints), flown])
    return {name: postures[:, number] for number, name in enumerate(settings.joints)}


def _title(study: Study, design: Design) -> str:
    words = ", ".join(f"{key} = {value_text(value)}" for key, value in design.items())
    return f"{study.title}: {words}"


def _values(study: Study, design: Design) -> dict[str, str]:
    """Design values in words by name with unit: offset_mm."""
    units = {variable.name: variable.unit for variable in study.space.variables}
    return {"_".join(filter(None, (name, units[name]))): value_text(value) for name, value in design.items()}


def _write_models(
    robot: RobotDescription,
    settings: dyn.FlightSettings,
    log: dyn.FlightLog,
    formats: Collection[str],
    folder: Path,
    package: RosPackage,
    how: Simplification,
) -> None:
    postures = flown_postures(settings, log)
    robot, words = simplified(robot, how, [jet.frame for jet in settings.actuators], postures)
    readable = with_obj_meshes(robot)
    ignored = ignored_pairs(readable, postures)
    robot = with_tiny_inertials(robot) if how.frames == "tiny" else robot
    robot = robot.with_elements([], {}, words).with_elements(urdf_collision_filters(ignored), NAMESPACE, BOUNDS)
    robot.write(folder / "robot.urdf")
    srdf = srdf_text(readable, settings, ignored)
    write_text(folder / "robot.srdf", srdf)
    if "ros2" in formats:
        write_ros2_package(robot, srdf, settings, package, folder.parent / "ros2")
    robot = readable
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
