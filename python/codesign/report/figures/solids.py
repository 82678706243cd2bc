"""Figures of solids: stress on the parts, the parts on the robot before and after, snapshots of the flight."""

from __future__ import annotations

import textwrap
from typing import Any

import numpy as np
from numpy.typing import NDArray

from codesign.chain.flight import find_trajectory
from codesign.problem.design_space import value_text
from codesign.problem.evaluation import Evaluation
from codesign.problem.quantities import words
from codesign.report.details import FlightHistory, StressField
from codesign.report.figures import style
from codesign.report.figures.data import FigureData
from codesign.report.figures.flights import sample_at
from codesign.report.raster import Array, Body, View, fitting_view, render
from codesign.report.scene import RobotScene, robot_scene, round_number, with_descendants
from codesign.report.words import number
from codesign.transforms import Matrix

PART_VIEW = (-55.0, 28.0)  # azimuth, elevation [deg]
ROBOT_VIEW = (148.0, 22.0)  # relative to where the robot looks
SNAPSHOTS = 7
SETTLED = 0.8  # of the time before the first command: the robot hovers, its joints have settled
FLAME, HOT = np.array([0.96, 0.55, 0.16]), np.array([1.0, 0.93, 0.75])
THRUST = np.array([0.25, 0.45, 0.75])  # of propellers
FLAME_LENGTH = 0.3  # of the robot's size, at the largest thrust
FLAME_RADIUS = 0.025  # of the robot's size


def stress(data: FigureData) -> Any:
    """Von Mises stress on every part of the original and of the recommended design, one scale a part.

    The scale ends at the peak that decides the safety factor; beyond it lie clamped edges, where stress has no limit.
    """
    from matplotlib.figure import Figure

    shown = {name: (e, d) for name, e in data.compared.items() if (d := data.detail(e)) is not None and d.parts}
    if not shown:
        return None
    parts = list(next(iter(shown.values()))[1].parts)
    figure = Figure(figsize=(style.PAGE, 2.3 * len(shown)))
    grid = np.array(figure.subplots(len(shown), len(parts), squeeze=False))
    for column, part in enumerate(parts):
        highest = max(detail.parts[part].peak for _, detail in shown.values())
        for row, (name, (evaluation, detail)) in enumerate(shown.items()):
            axes = grid[row, column]
            show_picture(axes, _stress_picture(detail.parts[part], highest))
            numbers = evaluation.parts.get(part, {})
            factor = f": safety factor {number(known, 3)}" if (known := numbers.get("safety_factor")) else ""
            axes.set_title(f"{words(part)}, {name}{factor}", pad=2)
        stress_bar(figure, grid[:, column], highest)
    return figure


def stress_bar(figure: Any, axes: Any, highest: float) -> None:
    """Color bar of von Mises stress from 0 to `highest` [Pa]."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    scale = ScalarMappable(Normalize(0.0, highest / 1e6), style.stress_colors())
    bar = figure.colorbar(scale, ax=axes, aspect=40, pad=0.02, extend="max")
    bar.set_label("von Mises stress (MPa)")
    bar.outline.set_visible(False)


def _stress_picture(part: StressField, highest: float) -> NDArray[np.uint8]:
    body = Body(part.points, part.triangles, stress_tint(part.von_mises, highest))
    return render([body], fitting_view([body], *PART_VIEW, aspect=1.5), 660, 440)


def stress_tint(von_mises: Array, highest: float) -> Array:
    """Colors (n, 3) of stresses (n,) on a scale that ends at `highest` [Pa]."""
    return np.asarray(style.stress_colors()(von_mises / max(highest, 1e-30))[:, :3])


def parts_on_robot(data: FigureData) -> Any:
    """The robot with the original and with the recommended parts, colored."""
    from matplotlib.figure import Figure

    if data.study is None or len(data.compared) < 2:
        return None
    figure = Figure(figsize=(style.PAGE, 3.9))
    view = None
    for axes, (name, evaluation) in zip(figure.subplots(1, 2), data.compared.items(), strict=True):
        joints, base = posture(data, evaluation)
        bodies, near = close_up(robot_scene(data.study, evaluation.design), joints, base)
        view = view or fitting_view(near, *facing(base), aspect=0.95)
        show_picture(axes, render(bodies, view, 760, 800))
        values = ", ".join(
            f"{data.run.label(v).lower()} {value_text(evaluation.design[v.name])}" for v in data.run.variables
        )
        axes.set_title(words(name), loc="center")
        axes.text(0.5, -0.02, textwrap.fill(values, 48), transform=axes.transAxes, ha="center", va="top", fontsize=7)
    return figure


def hero(data: FigureData, width: int = 460, height: int = 560) -> NDArray[np.uint8] | None:
    """Picture of the robot with the recommended (or the original) design's parts, for the page."""
    if data.study is None or not data.compared:
        return None
    evaluation = data.recommended or next(iter(data.compared.values()))
    joints, base = posture(data, evaluation)
    bodies, near = close_up(robot_scene(data.study, evaluation.design), joints, base)
    return render(bodies, fitting_view(near, *facing(base), aspect=width / height), width, height)


def close_up(scene: RobotScene, joints: Array | None, base: Matrix) -> tuple[list[Body], list[Body]]:
    """All bodies of the robot at joints (n,) [rad]; those that must be in the picture: parts and what they carry."""
    bodies = robot_bodies(scene, joints, base)
    parts = {piece.link for piece in scene.pieces if piece.part is not None}
    carried = with_descendants(scene.robot, parts | set(scene.jets))
    return bodies, [body for body, piece in zip(bodies, scene.pieces, strict=True) if piece.link in carried]


def posture(data: FigureData, evaluation: Evaluation) -> tuple[Array, Matrix]:
    """Joint positions (n,) [rad] and base pose (4, 4) in mid-flight, or at the start if the flight was not kept."""
    detail = data.detail(evaluation)
    if detail is None or detail.flight is None:
        flight = data.study.config.flight
        groups = [] if flight is None else flight.joint_groups
        return np.array([angle for group in groups for angle in group.initial_rad], dtype=float), np.eye(4)
    k = sample_at(detail.flight, hover_time(data.study, detail.flight))
    return detail.flight["joint_positions"][k], base_pose(detail.flight, k)


def hover_time(study: Any, flight: FlightHistory) -> float:
    """A moment of a flight at which the robot hovers: before the first command, or at the end if there is none [s]."""
    windows = find_trajectory(study.config, flight.trajectory).windows
    return min((SETTLED * window.from_s for window in windows), default=float(flight["time"][-1]))


def base_pose(flight: FlightHistory, k: int | slice) -> Matrix:
    """world_T_base (4, 4), or (n, 4, 4) for a slice, of a history."""
    rotation = flight["base_rotation"][k]
    pose = np.zeros((*rotation.shape[:-2], 4, 4))
    pose[..., :3, :3], pose[..., :3, 3], pose[..., 3, 3] = rotation, flight["base_position"][k], 1.0
    return pose


def facing(base: Matrix) -> tuple[float, float]:
    """Azimuth and elevation [deg] from which a robot with this base pose is seen from the front."""
    return float(np.degrees(np.arctan2(base[1, 0], base[0, 0]))) + ROBOT_VIEW[0], ROBOT_VIEW[1]


def robot_bodies(
    scene: RobotScene, joints: Array | None, base: Matrix | None, thrusts: Array | None = None
) -> list[Body]:
    """The robot in one posture; the design's parts stand out.

    thrusts: (jets,) [N]; flames of jets, cones along the thrust of propellers.
    """
    poses = scene.poses(joints, base)
    bodies = []
    for piece in scene.pieces:
        pose = poses[piece.link]
        color = style.PART if piece.part is not None else tuple(0.45 + 0.55 * c for c in piece.color)
        bodies.append(Body(piece.points @ pose[:3, :3].T + pose[:3, 3], piece.triangles, np.array(color)))
    for jet, push, thrust in zip(scene.jets, scene.pushes, [] if thrusts is None else thrusts, strict=False):
        share = float(thrust) / scene.max_thrust
        bodies.append(
            _cone(poses[jet], push, share, scene.size, THRUST, THRUST)
            if scene.propellers
            else _cone(poses[jet], -push, share, scene.size, FLAME, HOT)
        )
    return bodies


def _cone(pose: Matrix, along: Array, share: float, size: float, root: Array, tip: Array) -> Body:
    """A cone along a unit vector of a frame, as long as its share of the largest thrust; colors at its root and tip."""
    from trimesh import creation
    from trimesh.geometry import align_vectors

    length = size * max(FLAME_LENGTH * share, 1e-3)
    cone = creation.cone(radius=FLAME_RADIUS * size, height=length, sections=20)
    align: Any = align_vectors
    turn = pose[:3, :3] @ align([0.0, 0.0, 1.0], along)[:3, :3]
    points = np.asarray(cone.vertices) @ turn.T + pose[:3, 3]
    fade = np.clip(np.asarray(cone.vertices)[:, 2:] / length, 0.0, 1.0)
    return Body(
        points,
        np.asarray(cone.faces, dtype=np.int64),
        root * (1 - fade) + tip * fade,
        lit=False,
    )


def snapshots(data: FigureData) -> Any:
    """The flight in one picture: the robot at equal times, in its true places, with the path of its center of mass."""
    from matplotlib.figure import Figure

    evaluation = data.recommended or data.run.baseline
    detail = data.detail(evaluation)
    if data.study is None or evaluation is None or detail is None or detail.flight is None:
        return None
    flight = detail.flight
    scene = robot_scene(data.study, evaluation.design)
    rows = _spread_over_path(flight)
    bodies = [
        b
        for k in rows
        for b in robot_bodies(scene, flight["joint_positions"][k], base_pose(flight, k), flight["thrust"][k])
    ]
    yaw = np.degrees(np.arctan2(flight["base_rotation"][0, 1, 0], flight["base_rotation"][0, 0, 0]))
    view = fitting_view(bodies, yaw - 90.0, 6.0, aspect=1.5)
    figure = Figure(figsize=(style.PAGE, style.PAGE / 1.5))
    axes = figure.subplots()
    show_picture(axes, render(bodies, view, 1500, 1000), view)
    path = on_screen(view, flight["com"])
    axes.plot(*path.T, color=style.BLUE, linewidth=0.8, zorder=0)
    for k in rows:
        label = f"{flight['time'][k]:.0f} s"
        axes.annotate(label, path[k], (20, 6), textcoords="offset points", fontsize=7, color=style.MUTED)
    _scale_bar(axes, view)
    return figure


def _spread_over_path(flight: FlightHistory) -> list[int]:
    """Rows of a history that lie at equal distances along the path, the last one at its end."""
    length = np.cumsum(
        np.linalg.norm(np.diff(flight["com_reference"], axis=0, prepend=flight["com_reference"][:1]), axis=1)
    )
    rows = np.searchsorted(length, np.linspace(0.0, length[-1], SNAPSHOTS)[:-1])
    return [int(min(k, len(length) - 1)) for k in rows] + [len(length) - 1]


def show_picture(axes: Any, image: NDArray[np.uint8], view: View | None = None) -> None:
    """An image (h, w, 3) without axes; with a view, coordinates are meters on the screen, from its center."""
    extent = None
    if view is not None:
        half = view.height / 2.0
        wide = half * image.shape[1] / image.shape[0]
        extent = (-wide, wide, -half, half)
    axes.imshow(image, extent=extent, interpolation="antialiased")
    axes.set_axis_off()


def on_screen(view: View, points: Array) -> Array:
    """Screen coordinates (n, 2) [m] of points (n, 3)."""
    return np.asarray((points - np.array(view.center)) @ view.axes()[:2].T)


def _scale_bar(axes: Any, view: View) -> None:
    left, bottom = -0.72 * view.height, -0.46 * view.height
    length = round_number(0.2 * view.height)
    axes.plot([left, left + length], [bottom, bottom], color=style.INK, linewidth=1.2)
    label = f"{length:g} m"
    axes.text(left + length / 2.0, bottom + 0.01 * view.height, label, ha="center", va="bottom", fontsize=7)
