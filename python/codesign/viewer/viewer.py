"""A robot in the browser: a design's parts coloured by stress, its flight played back with thrusts.

`view` starts a local web server (viser) and returns a Viewer; `record` writes one flight as a single HTML file that
plays without a server. Nothing is loaded from other hosts.
"""

from __future__ import annotations

import contextlib
import io
import threading
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from numpy.typing import NDArray
from trimesh.visual import TextureVisuals
from trimesh.visual.material import PBRMaterial

from codesign.errors import CodesignError, ExecutionError
from codesign.files import write_text
from codesign.problem.design_space import value_text
from codesign.problem.evaluation import Evaluation
from codesign.report.compute import compute_detail
from codesign.report.details import FOLDER, Detail, detail_key, load_details, save_detail
from codesign.report.figures.flights import sample_at
from codesign.report.figures.solids import base_pose, stress_tint
from codesign.report.reading import read_report_data, same_study, study_of
from codesign.report.scene import Piece, robot_scene, round_number
from codesign.report.words import number, percent
from codesign.transforms import Matrix

FRAMES_PER_SECOND = 20.0
RECORDED_PER_SECOND = 12.5
ARROW_LENGTH = 0.33  # of the thrust arrows at the largest thrust, of the robot's size
LINE = 0.0065  # radius of arrows and paths, of the robot's size
SRGB_EXPONENT = 2.2  # of screen colours, roughly
CLOSE = 1.1  # from the robot to the camera that follows it, of the robot's size
SPEEDS = {"¼ ×": 0.25, "½ ×": 0.5, "1 ×": 1.0, "2 ×": 2.0, "4 ×": 4.0}
PART = (0, 114, 178)
ARROW = (230, 122, 20)
PATH = (90, 98, 110)
REFERENCE = (190, 195, 200)

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Choice:
    """A design that can be picked: how it is called, its evaluation (None: not evaluated yet), its values."""

    name: str
    design: dict[str, float]
    evaluation: Evaluation | None = None


def view(
    study: Any,
    design: Mapping[str, float] | None = None,
    *,
    run_directory: str | Path | None = None,
    trajectory: str | None = None,
    host: str = "127.0.0.1",
    port: int = 8080,
    packages: tuple[Path, ...] | None = None,
) -> Viewer:
    """Starts the viewer and returns it; `viewer.wait()` blocks until Ctrl-C, `viewer.stop()` ends it.

    Args:
        study: the study; None with a run_directory: the run's.
        design: what to show first, with the run's designs to choose from if run_directory is given.
        trajectory: of the study, by default its own.   packages: folders searched for the robot's real link meshes.
    Raises: StoreError, StudyError, DesignError; CodesignError if the first design cannot be built or flown.
    """
    choices, study, details = _choices(study, design, run_directory)
    return Viewer(study, choices, details, _folder(run_directory, study), trajectory, host, port, packages)


def record(
    path: str | Path,
    study: Any,
    design: Mapping[str, float] | None = None,
    *,
    run_directory: str | Path | None = None,
    trajectory: str | None = None,
    packages: tuple[Path, ...] | None = None,
) -> Path:
    """Writes one design's flight as a single HTML file with a time line; arguments as for `view`."""
    viewer = view(study, design, run_directory=run_directory, trajectory=trajectory, port=0, packages=packages)
    try:
        return write_text(path, viewer.recording())
    finally:
        viewer.stop()


def _choices(
    study: Any, design: Mapping[str, float] | None, run_directory: str | Path | None
) -> tuple[list[Choice], Any, dict[str, Detail]]:
    """What can be picked, the one to show first at the head; the study; details that are known."""
    choices: list[Choice] = []
    details: dict[str, Detail] = {}
    if run_directory is not None:
        directory = Path(run_directory)
        study = study if study is not None else study_of(directory)
        run = read_report_data(directory, study)
        details = load_details(directory)
        choices += [Choice(role, dict(e.design), e) for role, e in run.highlights.items()]
        known = [choice.design for choice in choices]
        front = [run.entries[i] for i in run.front]
        choices += [
            Choice(f"design {e.id}", dict(e.evaluation.design), e.evaluation)
            for e in front
            if e.evaluation.design not in known
        ]
    if study is None:
        raise CodesignError("the study cannot be loaded, so its robot cannot be shown")
    if design is not None:
        values = study.space.design(design).to_dict()
        choices = [Choice(", ".join(f"{k} {value_text(v)}" for k, v in values.items()), values), *choices]
    if study.baseline is not None and all(c.design != study.baseline.to_dict() for c in choices):
        choices.append(Choice("original", study.baseline.to_dict()))
    if not choices:
        raise CodesignError("nothing to show: give a design, or a run that has designs")
    return choices, study, details


def _folder(run_directory: str | Path | None, study: Any) -> Path | None:
    """Where computed details are kept: beside the run, if the study is still the run's."""
    if run_directory is None or not same_study(Path(run_directory), study):
        return None
    return Path(run_directory) / FOLDER


class Viewer:
    """A running viewer. Made by `view`."""

    def __init__(
        self,
        study: Any,
        choices: list[Choice],
        details: dict[str, Detail],
        folder: Path | None,
        trajectory: str | None,
        host: str,
        port: int,
        packages: tuple[Path, ...] | None,
    ) -> None:
        try:
            import viser
        except ImportError as error:
            raise ExecutionError("the viewer needs the package viser: pip install 'codesign[view]'") from error
        self._study, self._choices, self._details, self._folder = study, choices, dict(details), folder
        self._trajectory, self._packages = trajectory, packages
        with contextlib.redirect_stdout(io.StringIO()):  # viser's own banner
            self._server: Any = viser.ViserServer(host=host, port=port, label="codesign", verbose=False)
        self._lock = threading.RLock()
        self._ended = threading.Event()
        self._k = 0
        self._set_stage()
        self._make_controls()
        self.show(choices[0].name)
        self._player = threading.Thread(target=self._play, name="codesign playback", daemon=True)
        self._player.start()

    # ---- what a program can do

    @property
    def address(self) -> str:
        """Where to point the browser."""
        return f"http://{self._server.get_host()}:{self._server.get_port()}"

    @property
    def time(self) -> float:
        """The moment shown [s]."""
        return float(self._flight["time"][self._k]) if self._flight is not None else 0.0

    @property
    def playing(self) -> bool:
        """Whether time is running."""
        return bool(self._button.label == "Pause")

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the designs that can be shown."""
        return tuple(choice.name for choice in self._choices)

    @property
    def facts(self) -> str:
        """What is said of the design shown, as Markdown."""
        return str(self._status.content)

    def link_position(self, link: str) -> tuple[float, float, float]:
        """Where a link is at the moment shown, world axes [m]."""
        x, y, z = self._frames[link].position
        return float(x), float(y), float(z)

    def show(self, name: str) -> None:
        """Shows another design, by its name in the list; computes its stress and flight if they are not known."""
        choice = next(c for c in self._choices if c.name == name)
        with self._lock:
            self._status.content = f"Computing **{choice.name}** …"
            detail = self._detail(choice)
            self._choice, self._detail_shown, self._flight = choice, detail, detail.flight
            self._scene = robot_scene(self._study, choice.design, detail.parts, self._packages)
            self._thrusts.label = f"Thrusts (1 m is {self._newtons_per_metre:g} N)"
            self._compute_motion()
            self._build_scene()
            self._pose(0)
            self._slider.max = float(self._flight["time"][-1]) if self._flight is not None else 0.04
            self.go_to(min(self.time, self._slider.max))
            self._status.content = self._facts()

    def go_to(self, time: float) -> None:
        """Shows a moment of the flight [s]."""
        if self._flight is None:
            return
        with self._lock:
            self._k = sample_at(self._flight, time)
            self._pose(self._k)
            self._slider.value = round(self.time, 2)

    def wait(self) -> None:
        """Blocks until `stop`, or Ctrl-C."""
        try:
            self._ended.wait()
        except KeyboardInterrupt:
            self.stop()

    def stop(self) -> None:
        """Ends the server."""
        self._ended.set()
        with contextlib.redirect_stdout(io.StringIO()):
            self._server.stop()

    def recording(self) -> str:
        """The flight shown, as one HTML text that plays in a browser without a server."""
        if self._flight is None:
            raise CodesignError("this design has no flight to record")
        with self._lock:
            end = float(self._flight["time"][-1])
            self.go_to(0.0)
            serializer = self._server.get_scene_serializer()
            for moment in np.arange(0.0, end + 1e-9, 1.0 / RECORDED_PER_SECOND):
                self._pose(sample_at(self._flight, float(moment)))
                serializer.insert_sleep(1.0 / RECORDED_PER_SECOND)
            return str(serializer.as_html())

    # ---- scene

    def _set_stage(self) -> None:
        scene = self._server.scene
        scene.set_up_direction("+z")
        scene.configure_environment_map(None)  # the maps would be fetched from another host
        scene.enable_default_lights(cast_shadow=False)
        scene.add_light_ambient("/light/ambient", intensity=1.2)
        self._world = scene.add_frame("/world", show_axes=False)  # moves under the robot while the camera follows it
        self._server.gui.configure_theme(
            control_layout="collapsible", show_logo=False, show_share_button=False, brand_color=PART
        )

    def _build_scene(self) -> None:
        scene = self._server.scene
        with self._server.atomic():
            scene.remove_by_name("/world/robot")
            scene.remove_by_name("/world/path")
            self._lay_ground()
            self._frames = {
                link: scene.add_frame(f"/world/robot/{link}", show_axes=False) for link in self._scene.links
            }
            self._part_meshes: list[tuple[Any, Any]] = []
            for n, piece in enumerate(self._scene.pieces):
                self._add_piece(f"/world/robot/{piece.link}/{n}", piece)
            if self._flight is not None:
                none = np.zeros((len(self._flight.jets), 2, 3))
                self._arrows = scene.add_arrows(
                    "/world/robot/thrusts",
                    none,
                    ARROW,
                    shaft_radius=LINE * self._scene.size,
                    head_radius=2.5 * LINE * self._scene.size,
                    head_length=5.0 * LINE * self._scene.size,
                )
                self._add_path("/world/path/reference", self._flight["com_reference"], REFERENCE)
                self._add_path("/world/path/flown", self._flight["com"], PATH)
        self._show_layers()
        self._aim()

    def _lay_ground(self) -> None:
        """A grid of which the robot covers a few squares, large enough for its whole path."""
        size = self._scene.size
        section = round_number(0.5 * size)
        path = 0.0 if self._flight is None else float(np.abs(self._flight["com"][:, :2]).max())
        wide = 2.0 * section * np.ceil((path + 10.0 * size) / section)
        self._server.scene.add_grid(
            "/world/ground", width=wide, height=wide, cell_size=section / 2.0, section_size=section,
            cell_color=(225, 227, 230), section_color=(205, 208, 212), fade_distance=13.0 * size,
        )  # fmt: skip

    def _add_piece(self, name: str, piece: Piece) -> None:
        """A solid in its colour; a part with stresses a second time, in theirs."""
        scene, points, triangles = (
            self._server.scene,
            piece.points.astype(np.float32),
            piece.triangles.astype(np.uint32),
        )
        colour = PART if piece.part else tuple(int(255 * c) for c in piece.colour)
        plain = scene.add_mesh_simple(name, points, triangles, color=colour, flat_shading=True)
        if piece.part is not None and piece.values is not None:
            highest = self._detail_shown.parts[piece.part].peak  # what the safety factor is made from
            coloured = _coloured(piece.points, triangles, stress_tint(piece.values, highest))
            stressed = scene.add_mesh_trimesh(f"{name}_stress", coloured)
            self._part_meshes.append((plain, stressed))

    def _add_path(self, name: str, points: Array, colour: tuple[int, int, int]) -> None:
        segments = np.stack([points[:-1], points[1:]], axis=1)
        self._server.scene.add_line_segments(
            name, segments.astype(np.float32), colour, thickness=LINE * self._scene.size
        )

    def _aim(self) -> None:
        """Puts all cameras, also those to come, to the robot's front left: near it, or where its whole path is seen."""
        if self._flight is None:
            return
        start, path = self._flight["com"][0], self._flight["com"]
        close = CLOSE * self._scene.size
        target, distance = start, close
        if not self._follow.value:
            target = 0.5 * (start + (path.min(axis=0) + path.max(axis=0)) / 2.0)
            distance = max(close, float(np.linalg.norm(np.ptp(path, axis=0))))
        ahead = self._flight["base_rotation"][0, :, 0]
        side = np.array([-ahead[1], ahead[0], 0.0])
        position = target + distance * (0.4 * ahead + 0.65 * side + np.array([0.0, 0.0, 0.25]))
        for camera in (self._server.initial_camera, *(client.camera for client in self._server.get_clients().values())):
            camera.position, camera.look_at = tuple(position), tuple(target)

    def _follow_or_not(self) -> None:
        self._pose(self._k)
        self._aim()

    def _compute_motion(self) -> None:
        """Places of all links and arrows at all samples, once a design."""
        flight = self._flight
        if flight is None:
            poses = self._scene.poses(None, np.eye(4)[None])
            self._motion = {link: _placed(poses[link]) for link in self._scene.links}
            return
        poses = self._scene.poses(flight["joint_positions"], base_pose(flight, slice(None)))
        self._motion = {link: _placed(poses[link]) for link in self._scene.links}
        jets = np.stack([poses[jet] for jet in flight.jets], axis=1)
        foot = jets[..., :3, 3]
        force = -jets[..., :3, 2] * flight["thrust"][..., None] / self._newtons_per_metre
        self._arrow_points = np.stack([foot, foot + force], axis=2).astype(np.float32)

    @property
    def _newtons_per_metre(self) -> float:
        """Scale of the thrust arrows [N/m]."""
        return round_number(self._scene.max_thrust / (ARROW_LENGTH * self._scene.size))

    def _pose(self, k: int) -> None:
        """Puts all links and arrows where they are at sample `k`."""
        with self._server.atomic():
            for link, frame in self._frames.items():
                turns, places = self._motion[link]
                frame.wxyz, frame.position = turns[k], places[k]
            if self._flight is not None:
                self._arrows.points = self._arrow_points[k]
                way = self._flight["com"][0] - self._flight["com"][k]
                self._world.position = tuple(way) if self._follow.value else (0.0, 0.0, 0.0)

    def _show_layers(self) -> None:
        for plain, stressed in self._part_meshes:
            stressed.visible, plain.visible = self._stress.value, not self._stress.value
        if self._flight is not None:
            self._arrows.visible = self._thrusts.value
            for name in ("/world/path/reference", "/world/path/flown"):
                handle = self._server.scene.get_handle_by_name(name)
                if handle is not None:
                    handle.visible = self._trail.value

    # ---- controls

    def _make_controls(self) -> None:
        gui = self._server.gui
        self._picker = gui.add_dropdown("Design", self.names)
        self._button = gui.add_button("Play")
        self._slider = gui.add_slider("Time (s)", 0.0, 0.04, 0.04, 0.0)
        self._speed = gui.add_dropdown("Speed", list(SPEEDS), initial_value="1 ×")
        self._follow = gui.add_checkbox("Camera follows the robot", True)
        with gui.add_folder("Show"):
            self._stress = gui.add_checkbox("Stress on the parts", True)
            self._thrusts = gui.add_checkbox("Thrusts", True)
            self._trail = gui.add_checkbox("Path: flown and wanted", True)
        self._status = gui.add_markdown("")
        self._picker.on_update(lambda _: self.show(self._picker.value))
        self._button.on_click(lambda _: setattr(self._button, "label", "Play" if self.playing else "Pause"))
        self._slider.on_update(lambda event: self.go_to(self._slider.value) if event.client is not None else None)
        self._follow.on_update(lambda _: self._follow_or_not())
        for layer in (self._stress, self._thrusts, self._trail):
            layer.on_update(lambda _: self._show_layers())

    def _play(self) -> None:
        """Advances time while playing; starts again at the end."""
        last = time.monotonic()
        while not self._ended.wait(1.0 / FRAMES_PER_SECOND):
            now = time.monotonic()
            passed, last = now - last, now
            if self.playing and self._flight is not None:
                moment = self._slider.value + passed * SPEEDS[self._speed.value]
                self.go_to(0.0 if moment > self._slider.max else moment)

    def _detail(self, choice: Choice) -> Detail:
        known = choice.evaluation
        if self._trajectory is None and known is not None and detail_key(known) in self._details:
            return self._details[detail_key(known)]
        flown = None if known is None else known.flight.get("trajectory")
        detail = compute_detail(self._study, choice.design, self._trajectory or flown)
        if self._trajectory is None:
            self._details[detail_key(detail.evaluation)] = detail
            if self._folder is not None:
                save_detail(self._folder, detail)
        return detail

    def _facts(self) -> str:
        """What is known of the design, as Markdown."""
        evaluation = self._detail_shown.evaluation
        lines = [f"**{evaluation.status}**" + (f": {evaluation.reason}" if evaluation.reason else "")]
        lines += [f"{key}: **{value_text(value)}**" for key, value in evaluation.design.items()]
        original = next((c.evaluation for c in self._choices if c.name == "original"), None)
        for key, value in evaluation.objectives.items():
            before = original.objectives.get(key) if original is not None else None
            change = f" ({percent((value - before) / abs(before))})" if before and original is not evaluation else ""
            lines.append(f"{key.replace('_', ' ')}: **{number(value)}**{change}")
        for name, part in evaluation.parts.items():
            if part.get("safety_factor"):
                lines.append(f"{name.replace('_', ' ')}: safety factor **{part['safety_factor']:.1f}**")
        return "\n\n".join(lines)


def _coloured(points: Array, triangles: NDArray[Any], colours: NDArray[Any]) -> trimesh.Trimesh:
    """A mesh with a colour (n, 3), 0 … 1, at each point; its material is no metal, which is black without a sky."""
    material = PBRMaterial(metallicFactor=0.0, roughnessFactor=0.9)  # type: ignore[no-untyped-call]
    visual = TextureVisuals(material=material)  # type: ignore[no-untyped-call]
    linear = np.column_stack([colours**SRGB_EXPONENT, np.ones(len(colours))])  # as glTF has it
    visual.vertex_attributes["color"] = np.rint(255 * linear).astype(np.uint8)
    return trimesh.Trimesh(points, triangles, visual=visual, process=False)


def _placed(poses: Matrix) -> tuple[Array, Array]:
    """Unit quaternions (k, 4) as w, x, y, z and positions (k, 3) of poses (k, 4, 4)."""
    return quaternions(poses[:, :3, :3]), np.ascontiguousarray(poses[:, :3, 3])


def quaternions(rotations: Array) -> Array:
    """Unit quaternions (k, 4) as w, x, y, z of rotations (k, 3, 3)."""
    from scipy.spatial.transform import Rotation

    return np.asarray(np.roll(Rotation.from_matrix(rotations).as_quat(), 1, axis=1))
