"""A study that gives every key of the configuration."""

import copy
import tomllib
from pathlib import Path
from typing import Any

from codesign.study import new_study

WHOLE = """
[[parts]]
name = "rod"
shape = "rod:Rod"
parameters = { length = "reach", width = "height" }
material = "steel"
density_kg_m3 = 7000.0
supports = ["bottom"]
loads = [{ face = "top", pressing_n = 100.0 }]
options = { depth = 20.0, name = "rod" }
masses = [{ face = "top", mass_kg = 0.1, point_mm = [0.0, 0.0, 0.0], inertia_kg_m2 = [1e-4, 1e-4, 1e-4] }]

[tolerances]
dimensions = "m"
angle_deg = 0.5
jet_angle_deg = 0.5
young_modulus = 0.02
yield_strength = 0.04
density = 0.01

[materials.steel]
young_modulus_gpa = 200.0
poisson_ratio = 0.3
yield_strength_mpa = 235.0
density_kg_m3 = 7850.0
ultimate_strength_mpa = 360.0
fatigue_strength_mpa = 170.0
fatigue_cycles = 1e7

[variables.gain]
min = 20.0
max = 80.0
step = 5.0
sets = ["flight.gains.attitude_proportional"]

[variables.width]
values = [16.0, 20.0, 24.0]
unit = "mm"
sets = ["parts.rod.options.depth"]

[variables.alloy]
choices = ["steel", "ti-6al-4v"]
sets = ["parts.rod.material"]

[variables.bar]
choices.flat = { wide = 30.0, "parts.rod.options.name" = "flat" }
choices.high = { wide = 40.0, "parts.rod.options.name" = "high" }

[flight.turbine]
K_T = 0.24
K_TT = -0.013
K_D = -0.86
K_DD = 0.024
K_TD = 0.0086
B_U = 1.14
B_T = 0.02
B_D = -0.05
B_UU = 0.0003
c = -0.69
throttle_gain = 50.0
max_throttle_percent = 120.0

[trajectories.gusty]
label = "gusty"
windows = [{ from_s = 0.1, to_s = 0.2, forward = 1.0, left = 0.0, up = 0.0, roll = 0.0, pitch = 0.0, yaw = 0.0 }]
[trajectories.gusty.disturbances]
wind_n = [1.0, 0.0, 0.0]
gust_deviation_n = [1.0, 1.0, 1.0]
gust_time_s = 1.0
mass_scale = 1.0
mass_deviation = 0.01
thrust_deviation = 0.01
seed = 3

[interference]
bodies = ["front_strut"]
ignore = [["front_strut", "left_strut"]]
report_below_mm = 50.0
postures = 5
slices = 2
plumes = { jets = ["front_jet"], half_angle_deg = 11.8, radius_mm = 34.0, start_mm = 5.0, length_mm = 500.0 }
"""
ROD = """
from dataclasses import KW_ONLY, dataclass

from codesign.geometry.shape import Shape, box
from codesign.parts.part import Part, parameter


@dataclass(frozen=True)
class Rod(Part):
    length: float = parameter("mm", minimum=10.0)
    width: float = parameter("mm", minimum=1.0)
    _: KW_ONLY
    name: str = "rod"
    density: float = 7850.0
    depth: float = 20.0

    def shape(self) -> Shape:
        return box((0, 0, 0), (self.width, self.depth, self.length), z0="bottom", z1="top")
"""


def complete_flight(raw: dict[str, Any]) -> None:
    """Fills in start, rates, drives, air and fuel of the flight."""
    raw |= {"extends": "", "without": []}
    raw["flight"] |= {
        "controller": "momentum_qp", "jet_model": "turbine", "duration_s": 0.08, "torque_step_s": 0.004,
        "hold_inertia": True, "plant_step_s": 0.002,
        "integrator": "runge_kutta_4", "seeds": [1, 2],
        "drives": {"momentum_delay_s": 0.008, "torque_delay_s": 0.004, "torque_lag_s": 0.005, "slip_speed_rad_s": 0.02},
        "drag": {"frames": ["front_jet"], "areas_m2": [0.2], "positions_m": [[0.0, 0.0, 0.1]],
                 "air_density_kg_m3": 1.2},
        "tank": {"frame": "front_jet", "position_m": [0.0, 0.0, 0.0], "fuel_kg": 0.01, "consumption_kg_per_n_s": 1e-5},
    }  # fmt: skip
    raw["flight"]["initial_state"] |= {"base_rpy_deg": [0.0, 0.0, 0.0], "free_fall_first_step": False}
    group = raw["flight"]["joint_groups"][0]
    raw["flight"]["initial_state"]["trim"] = {"joints": group["joints"], "tilt_weight": 3.0, "thrust_weight": 0.003}
    group |= {"range_scale": 1.0, "reference_rad": list(group["initial_rad"]), "rotor_inertia_kg_m2": 0.01}
    group |= {"viscous_friction_n_m_per_rad_s": 0.1, "coulomb_friction_n_m": [0.1] * len(group["joints"])}
    raw["flight"]["gains"]["observer_hz"], wind = 5.0, {"wind_m_s": [2.0, 0.0, 0.0]}
    raw["trajectories"]["gusty"]["disturbances"] |= wind


def complete(raw: dict[str, Any]) -> None:
    """Fills in what has a default, so that every key of the configuration has a value."""
    raw["robot"]["visuals"] = "package://absent/robot.urdf"
    stretch = {"link": "front_strut", "direction": [0.0, 0.0, 1.0], "from_m": -0.1, "to_m": 0.1, "pole_m": 0.0}
    raw["robot"]["changes"] = [{"variable": "reach", **stretch, "per_unit": 1.0, "mass_share": 1.0}]
    for name, variable in raw["variables"].items():
        raw["variables"][name] = {"unit": "", "label": f"the {name}", "sets": []} | variable
    raw["baseline"] |= {"gain": 50.0, "width": 20.0, "alloy": "steel", "bar": "flat"}
    raw["parts"][0] |= {"density_kg_m3": 2810.0, "options": {"name": "strut"}}
    place = raw["parts"][0]["placements"][0]
    pose = {"xyz_mm": [0.0, 0.0, 0.0], "rpy_deg": [0.0, 0.0, 0.0]}
    place |= {"link_T_part": copy.deepcopy(pose), "mirror": "y"}
    place["joints"]["front_roll"]["interface_T_child"] = pose
    interface = place["joints"]["front_roll"]["interface"]
    loads = [
        *raw["parts"][0].pop("loads"),
        {"face": "seat", "force_n": [0.0, 0.0, -9.0], "point_mm": [1.0, 0.0, 0.0], "moment_n_m": [1.0, 0.0, 0.0]},
        {"face": "seat", "interface": interface, "force_n": [0.0, 0.0, -9.0], "moment_n_m": [1.0, 0.0, 0.0]},
        {"face": "seat", "bearing_n": [0.0, 0.0, 9.0]},
        {"face": "seat", "moment_n_m": [1.0, 0.0, 0.0]},
        {"face": "seat", "pressure_mpa": 1.0},
        {"face": "seat", "traction_mpa": [0.0, 0.0, -1.0]},
        {"acceleration_m_s2": [0.0, 0.0, -9.81]},
    ]
    raw["parts"][0]["cases"] = [
        {"name": "thrust", "loads": loads, "safety_factor_min": 5.0},
        {"name": "flown", "flown": {interface: "seat"}, "safety_factor_min": 5.0},
    ]
    mass = {"mass_kg": 0.1, "point_mm": [0.0, 0.0, 9.0], "inertia_kg_m2": [0, 0, 0]}
    raw["parts"][0]["masses"] = [{"face": "seat", "interface": interface, **mass}]
    raw["fem"] |= {"load": "uniform", "support": "published", "exclusion_distance_mm": 3.0, "memory_limit_mib": 1400}
    raw["fem"]["edge_length_mm"] = 2.0
    complete_flight(raw)
    raw["flight"]["jets"] |= {
        "symmetric_pairs": [["front_jet", "rear_jet"]], "min_thrust_n": 5.0, "axes": 4 * [[0.0, 0.0, -1.0]],
        "reaction_n_m_per_n": 0.01, "senses": [1, -1, 1, -1], "lag_s": [0.05, 0.05, 0.06, 0.06],
    }  # fmt: skip
    raw["flight"]["ground"]["height_m"] = 0.0
    raw["objectives"]["maximize"] = ["parts.strut.safety_factor"]
    raw["constraints"] |= {
        "body_clearance_min_mm": 1.0, "plume_clearance_min_mm": 1.0, "first_frequency_min_hz": 10.0,
        "buckling_factor_min": 2.0, "limits": {"flight.max_torque": {"min": 0.0, "max": 60.0}},
    }  # fmt: skip
    raw["optimizer"] |= {"algorithm": "nsga2", "crossover_probability": 0.9, "mutation_probability": 0.2, "seed": 1}
    raw["optimizer"]["evaluations"], raw["execution"]["lazy"] = 160, True


def write_whole_study(folder: Path) -> tuple[dict[str, Any], Path]:
    """The study as read from its file, and where that file would be, in a new folder."""
    new_study(folder)
    (folder / "rod.py").write_text(ROD)
    path = folder / "study.toml"
    raw = tomllib.loads(path.read_text() + WHOLE)
    complete(raw)
    return raw, path


def predictive(raw: dict[str, Any]) -> dict[str, Any]:
    """The same study under the other controller, on a path through way-points, without what its flights do not have."""
    other = copy.deepcopy(raw)
    flight = other["flight"]
    joints = flight["joint_groups"][0]["joints"]
    for key in ("drives", "drag", "tank"):
        del flight[key]
    for key in ("viscous_friction_n_m_per_rad_s", "coulomb_friction_n_m"):
        del flight["joint_groups"][0][key]
    flight |= {"controller": "mpc", "jet_model": "identified", "trajectory": "routed", "seeds": []}
    flight["jet_models"] = {"identified": {
        "thrust_mean_n": 108.0, "thrust_scale_n": 66.0, "throttle_mean_percent": 47.0, "throttle_scale_percent": 31.0,
        "c": -0.46, "K_T": -8.1, "K_D": -6.2, "K_TD": 0.66, "K_TT": 1.7, "K_DD": -0.48, "B": 8.8, "B_T": -1.0,
        "B_D": -0.59, "B_TD": 0.52, "B_TT": -0.42, "B_DD": 0.1, "B_UU": 0.02, "max_throttle_percent": 100.0,
        "throttle_gain": 50.0,
    }}  # fmt: skip
    three = [1.0, 1.0, 1.0]
    flight["mpc"] = {
        "body": "body", "joints": joints[:4], "throttle_every": 5, "small_steps": 4, "large_steps": 3,
        "large_step_s": 0.1, "control_steps": 4, "joint_speed_rad_s": 2.0, "integral": "accumulate",
        "gravity_coupling": True, "jet_dynamics": True, "varying": True,
        "weights": dict.fromkeys(
            ("com", "com_integral", "linear_momentum", "attitude", "attitude_integral", "angular_momentum"), three
        ) | dict.fromkeys(("joint_displacement", "posture", "throttle_change", "throttle_first"), 1000.0),
        "weight_exponents": dict.fromkeys(
            ("com", "com_integral", "linear_momentum", "attitude", "attitude_integral", "angular_momentum",
             "joint_displacement", "throttle"), 0.0
        ),
    }  # fmt: skip
    group = {"joints": joints, "stiffness_n_m_rad": 500.0, "damping_ratio": 0.3, "passive_n_m_s_rad": 1.0}
    flight["servo"] = {"integrator": "implicit", "step_s": 0.004, "groups": [group]}
    flight["fuel"] = {"idle_kg_s": 1e-3, "kg_n_s": 1e-5}
    point = {"m": [0.5, 0.0, 0.5], "yaw_deg": 10.0, "duration_s": 2.0, "rest_s": 0.5}
    other["trajectories"] = {"routed": {
        "label": "routed", "kind": "stop", "rest_s": 0.1, "duration_s": 0.08, "waypoints": [point],
        "pulses": [{"at_s": 0.01, "for_s": 0.02, "force_n": [1.0, 0.0, 0.0], "moment_n_m": [0.0, 1.0, 0.0]}],
        "disturbances": raw["trajectories"]["gusty"]["disturbances"] | {"wind_m_s": [0.0, 0.0, 0.0]},
    }}  # fmt: skip
    other["validation"]["trajectories"] = ["routed"]
    return other
