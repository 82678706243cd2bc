"""A robot in the browser: a design's parts colored by stress, its flight played back with thrusts.

`view` starts a local web server (viser) and returns a Viewer; `record` writes one flight as a single HTML file that
plays without a server. Nothing is loaded from other hosts.
"""

from __future__ import annotations

import contextlib
import io
import threading
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from codesign.errors import CodesignError, ExecutionError
from codesign.files import check_target, write_text
from codesign.problem.design_space import DesignValue
from codesign.report.compute import compute_detail
from codesign.report.data import ReportData
from codesign.report.details import Detail, detail_key, save_detail
from codesign.report.link_meshes import absence_in_words, absent_meshes, package_paths
from codesign.report.page.what_if import what_if_models
from codesign.report.scene import robot_scene, round_number
from codesign.surrogate.what_if import WhatIf
from codesign.viewer.actor import PART, Actor, Array
from codesign.viewer.choices import ORIGINAL, Choice, details_folder, find_choices
from codesign.viewer.panel import facts, joint_angles, legend
from codesign.viewer.what_if import WhatIfPanel

FRAMES_PER_SECOND = 20.0
RECORDED_PER_SECOND = 12.5
CLOSE = 1.1  # from the robot to the camera that follows it, of the robot's size
CLOSE_TO_PART = 2.5  # of the part's size
BESIDE = 1.3  # from the design to the original beside it, of the robot's size
SPEEDS = {"¼ ×": 0.25, "½ ×": 0.5, "1 ×": 1.0, "2 ×": 2.0, "4 ×": 4.0}
ROBOT = "the robot"


def view(
    study: Any,
    design: Mapping[str, DesignValue] | None = None,
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
    choices, study, details, run = find_choices(study, design, run_directory)
    folder = details_folder(run_directory, study)
    viewer = Viewer(study, choices, details, folder, trajectory, host, port, packages)
    models = what_if_models(run) if run is not None else None
    if run is not None and models is not None:
        viewer.add_what_if(run, models)
    return viewer


def record(
    path: str | Path,
    study: Any,
    design: Mapping[str, DesignValue] | None = None,
    *,
    run_directory: str | Path | None = None,
    trajectory: str | None = None,
    packages: tuple[Path, ...] | None = None,
) -> Path:
    """Writes one design's flight as a single HTML file with a time line; arguments as for `view`."""
    check_target(path)
    viewer = view(study, design, run_directory=run_directory, trajectory=trajectory, port=0, packages=packages)
    try:
        return write_text(path, viewer.recording())
    finally:
        viewer.stop()


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
        self._trajectory = trajectory
        self._packages = package_paths() if packages is None else packages
        self._absent = absence_in_words(absent_meshes(study.base_robot, self._packages))
        with contextlib.redirect_stdout(io.StringIO()):  # viser's own banner
            self._server: Any = viser.ViserServer(host=host, port=port, label="codesign", verbose=False)
        self._lock = threading.RLock()
        self._ended = threading.Event()
        self._time = 0.0
        self._beside: Actor | None = None
        self.what_if: WhatIfPanel | None = None
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
        return self._time

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

    @property
    def world_position(self) -> tuple[float, float, float]:
        """Where the world's origin is shown: it moves under the robot while the camera follows it [m]."""
        x, y, z = self._world.position
        return float(x), float(y), float(z)

    def link_position(self, link: str) -> tuple[float, float, float]:
        """Where a link is at the moment shown, world axes [m]."""
        return self._actor.position(link)

    def add_what_if(self, run: ReportData, models: WhatIf) -> None:
        """Adds sliders of the design variables with predictions; see `what_if`."""
        self.what_if = WhatIfPanel(self._server, run, models)

    def show(self, name: str) -> None:
        """Shows another design, by its name in the list; computes its stress and flight if they are not known."""
        choice = next(c for c in self._choices if c.name == name)
        with self._lock:
            self._status.content = f"Computing **{choice.name}** …"
            self._choice, self._shown = choice, self._detail(choice)
            scene = robot_scene(self._study, choice.design, self._shown.parts, self._packages)
            self._time = 0.0
            with self._server.atomic():
                self._server.scene.remove_by_name("/world/robot")
                self._actor = Actor(self._server, "/world/robot", scene, self._shown, np.zeros(3))
                self._lay_ground()
            self._thrusts.label = f"Thrusts (1 m is {self._actor.newtons_per_meter:g} N)"
            self._legend.content = legend(self._shown)
            self._show_beside()
            self._show_layers()
            self._aim()
            self._slider.max = self._end or 1.0 / FRAMES_PER_SECOND
            self.go_to(0.0)
            self._status.content = self._facts()

    def go_to(self, time: float) -> None:
        """Shows a moment of the flight [s]."""
        with self._lock:
            self._time = min(max(time, 0.0), self._end)
            self._pose()
            self._slider.value = round(self._time, 2)

    def follow(self, robot: bool) -> None:
        """Whether the camera follows the robot, or stays where it is in the world."""
        self._follow.value = robot
        self._pose()
        self._aim()

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
        if self._shown.flight is None:
            raise CodesignError("this design has no flight to record")
        with self._lock:
            self.go_to(0.0)
            serializer = self._server.get_scene_serializer()
            for moment in np.arange(0.0, self._end + 1e-9, 1.0 / RECORDED_PER_SECOND):
                self._time = float(moment)
                self._pose()
                serializer.insert_sleep(1.0 / RECORDED_PER_SECOND)
            return str(serializer.as_html())

    # ---- scene

    @property
    def _end(self) -> float:
        """Duration of the flight shown [s]."""
        return float(self._shown.flight["time"][-1]) if self._shown.flight is not None else 0.0

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

    def _lay_ground(self) -> None:
        """A grid of which the robot covers a few squares, large enough for its whole path."""
        size, flight = self._actor.scene.size, self._shown.flight
        section = round_number(0.5 * size)
        path = 0.0 if flight is None else float(np.abs(flight["com"][:, :2]).max())
        wide = 2.0 * section * np.ceil((path + 10.0 * size) / section)
        self._server.scene.add_grid(
            "/world/ground", width=wide, height=wide, cell_size=section / 2.0, section_size=section,
            cell_color=(225, 227, 230), section_color=(205, 208, 212), fade_distance=13.0 * size,
        )  # fmt: skip

    def _show_beside(self) -> None:
        """The original design beside the one shown, on the same clock, if that is wanted and it is another."""
        if self._beside is not None:
            self._beside.remove()
            self._beside = None
        original = next((c for c in self._choices if c.name == ORIGINAL), None)
        if not self._with_original.value or original is None or original is self._choice:
            return
        detail = self._detail(original)
        scene = robot_scene(self._study, original.design, detail.parts, self._packages)
        _, side = self._heading()
        with self._server.atomic():
            self._beside = Actor(self._server, "/world/original", scene, detail, -BESIDE * scene.size * side)
            self._beside.pose(self._time)

    def _heading(self) -> tuple[Array, Array]:
        """Unit vectors ahead of the robot and to its left at the start of the flight, level (3,)."""
        flight = self._shown.flight
        ahead = np.array([1.0, 0.0, 0.0]) if flight is None else flight["base_rotation"][0, :, 0] * [1.0, 1.0, 0.0]
        ahead = ahead / (np.linalg.norm(ahead) or 1.0)
        return ahead, np.array([-ahead[1], ahead[0], 0.0])

    def _aim(self) -> None:
        """Puts all cameras, also those to come, to the robot's front left: near it, or where its whole path is seen."""
        size, flight = self._actor.scene.size, self._shown.flight
        start = np.array([0.0, 0.0, 0.0]) if flight is None else flight["com"][0]
        target, distance = start, CLOSE * size
        if self._look_at.value != ROBOT:
            target, part = self._actor.part_center(self._look_at.value)
            target, distance = target + np.array(self.world_position), CLOSE_TO_PART * part
        elif flight is not None and not self._follow.value:
            path = flight["com"]
            target = 0.5 * (start + (path.min(axis=0) + path.max(axis=0)) / 2.0)
            distance = max(distance, float(np.linalg.norm(np.ptp(path, axis=0))))
        ahead, side = self._heading()
        position = target + distance * (0.4 * ahead + 0.65 * side + np.array([0.0, 0.0, 0.25]))
        for camera in (self._server.initial_camera, *(client.camera for client in self._server.get_clients().values())):
            camera.position, camera.look_at = tuple(position), tuple(target)

    def _pose(self) -> None:
        """Puts everything where it is at the moment shown."""
        flight = self._shown.flight
        with self._server.atomic():
            self._actor.pose(self._time)
            if self._beside is not None:
                self._beside.pose(self._time)
            if flight is not None:
                way = flight["com"][0] - flight["com"][self._actor.sample]
                self._world.position = tuple(way) if self._follow.value else (0.0, 0.0, 0.0)
            if not self.playing:
                self._angles.content = joint_angles(self._shown, self._time)

    def _show_layers(self) -> None:
        for actor in (self._actor, self._beside):
            if actor is not None:
                actor.show(self._stress.value, self._thrusts.value, self._trail.value)

    # ---- controls

    def _make_controls(self) -> None:
        gui = self._server.gui
        self._picker = gui.add_dropdown("Design", self.names)
        self._button = gui.add_button("Play")
        self._slider = gui.add_slider("Time (s)", 0.0, 1.0 / FRAMES_PER_SECOND, 0.01, 0.0)
        self._speed = gui.add_dropdown("Speed", list(SPEEDS), initial_value="1 ×")
        self._look_at = gui.add_dropdown("Look at", [ROBOT, *(part.name for part in self._study.config.parts)])
        self._follow = gui.add_checkbox("Camera follows the robot", True)
        with gui.add_folder("Show"):
            self._stress = gui.add_checkbox("Stress on the parts", True)
            self._thrusts = gui.add_checkbox("Thrusts", True)
            self._trail = gui.add_checkbox("Path: flown and wanted", True)
            self._with_original = gui.add_checkbox("Original design beside it", False)
        self._legend = gui.add_html("")
        self._status = gui.add_markdown("")
        with gui.add_folder("Joint angles, when paused", expand_by_default=False):
            self._angles = gui.add_markdown("")
        self._picker.on_update(lambda _: self.show(self._picker.value))
        self._button.on_click(lambda _: self._play_or_pause())
        self._slider.on_update(lambda event: self.go_to(self._slider.value) if event.client is not None else None)
        self._follow.on_update(lambda _: self.follow(self._follow.value))
        self._look_at.on_update(lambda _: self._aim())
        self._with_original.on_update(lambda _: self._change_beside())
        for layer in (self._stress, self._thrusts, self._trail):
            layer.on_update(lambda _: self._show_layers())

    def _change_beside(self) -> None:
        with self._lock:
            self._show_beside()
            self._show_layers()

    def _play_or_pause(self) -> None:
        self._button.label = "Play" if self.playing else "Pause"
        self._pose()

    def _play(self) -> None:
        """Advances time while playing; starts again at the end."""
        last = time.monotonic()
        while not self._ended.wait(1.0 / FRAMES_PER_SECOND):
            now = time.monotonic()
            passed, last = now - last, now
            if self.playing and self._shown.flight is not None:
                moment = self._time + passed * SPEEDS[self._speed.value]
                self.go_to(0.0 if moment > self._end else moment)

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
        """What is known of the design shown, as Markdown, with a note on meshes that are missing."""
        original = next((c.evaluation for c in self._choices if c.name == ORIGINAL), None)
        shown = self._shown.evaluation
        verdict = next((choice.verdict for choice in self._choices if choice.design == shown.design), None)
        said = facts(self._study, shown, original, verdict)
        return f"{said}\n\n*{self._absent}*" if self._absent else said
