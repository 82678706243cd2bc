"""docs/figures/hexarotor.png, the picture at the head of the README: designs, their part, and a flight.

codesign optimize --study hexarotor --algorithm surrogate --evaluations 60 --seed 1 --original --out RUN
python scripts/readme_picture.py RUN
"""

import sys
from pathlib import Path

import matplotlib as mpl
import numpy as np

mpl.use("Agg")
import matplotlib.pyplot as plt
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from codesign import dynamics as dyn
from codesign.chain.flight import find_trajectory, flight_settings
from codesign.chain.study import Study, load_study
from codesign.storage.runs import load_run

OUT = Path(__file__).resolve().parents[1] / "docs" / "figures" / "hexarotor.png"
TUBE_COLORS = {"16x2": "#ff7f0e", "18x2": "#1f77b4", "20x2": "#2ca02c", "22x2": "#9467bd"}


def flown(study: Study, design: dict[str, float | str]) -> dyn.FlightLog:
    """The flight of a design."""
    config = study.configured(study.space.design(design))
    settings = flight_settings(config.flown, find_trajectory(config, config.flown.trajectory))
    return dyn.simulate_flight(dyn.load_urdf(study.build_robot(design), joints=[]), settings)


def draw_front(axes: plt.Axes, folder: str) -> None:
    """Mass over power of a run's feasible designs; the best compromises, in stiffness too, filled."""
    run = load_run(folder)
    best = [record.evaluation.design for record in run.front]
    for tube, color in TUBE_COLORS.items():
        for filled in (False, True):
            points = [
                (evaluation.objectives["propeller:power_in_watts"], evaluation.objectives["propeller:mass_in_kg"])
                for evaluation in run.evaluations
                if evaluation.status == "feasible"
                and evaluation.design["tube"] == tube
                and (evaluation.design in best) is filled
            ]
            if points:
                hollow = {"facecolors": "none", "edgecolors": color}
                style = {"color": color, "label": f"tube {tube}"} if filled else hollow
                axes.scatter(*np.array(points).T, s=26 if filled else 14, **style)
    axes.set(xlabel="power [W]", ylabel="mass of arms and rotors [kg]", title="designs, the best ones filled")
    axes.legend(frameon=False)


def draw_part(axes: plt.Axes, study: Study) -> None:
    """The arm of the baseline."""
    part = study.build_parts(study.baseline)["arm"]
    surface = part.surface()
    corners = 1e3 * surface.points[surface.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    shade = 0.55 + 0.45 * np.clip(normals @ (np.array([-0.4, -0.5, 0.8]) / 1.025), 0.0, 1.0)
    seat = np.asarray(surface.face) == list(surface.face_names).index("seat")
    colors = shade[:, None] * np.where(seat[:, None], (0.95, 0.45, 0.2), (0.45, 0.62, 0.85))
    axes.add_collection3d(Poly3DCollection(corners, facecolors=colors))
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]), title="its parametric arm")
    axes.set_box_aspect(high - low, zoom=0.85)
    axes.view_init(22, -62)
    axes.set_axis_off()


def draw_flight(axes: plt.Axes, study: Study) -> None:
    """The path of a flight, and the rotors with their thrusts at some instants."""
    log = flown(study, dict(study.baseline))
    axes.plot(*log.com.T, color="0.6", lw=1)
    robot = dyn.load_urdf(study.build_robot(study.baseline), joints=[])
    frames = study.config.flown.jets.frames
    for k in np.linspace(0, log.samples - 1, 7).astype(int):
        base = np.eye(4)
        base[:3, :3], base[:3, 3] = log.base_rotation[k], log.base_position[k]
        for jet, frame in enumerate(frames):
            pose = dyn.frame_pose(robot, base, [], frame)
            tip = pose[:3, 3] + 0.1 * log.thrust[k, jet] * pose[:3, 2]
            axes.plot(*np.array([base[:3, 3], pose[:3, 3]]).T, color="#1f4e79", lw=1.4)
            axes.plot(*np.array([pose[:3, 3], tip]).T, color="#d95f02", lw=1.1)
    axes.set(title="its flight, with thrusts")
    axes.set_aspect("equal")
    axes.view_init(24, -60)
    axes.tick_params(labelsize=6)


def main() -> None:
    """Draws and writes the picture."""
    study = load_study("hexarotor")
    figure = plt.figure(figsize=(12.0, 3.9), dpi=110, layout="constrained")
    draw_front(figure.add_subplot(1, 3, 1), sys.argv[1])
    draw_part(figure.add_subplot(1, 3, 2, projection="3d"), study)
    draw_flight(figure.add_subplot(1, 3, 3, projection="3d"), study)
    figure.savefig(OUT)
    print(OUT)


if __name__ == "__main__":
    main()
