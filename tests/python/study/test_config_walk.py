"""Every field of study.toml in turn with what people get wrong: flown, or refused by one line that helps."""

import copy
import functools
import json
import math
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import msgspec.inspect as kinds
import pytest

from codesign import dynamics as dyn
from codesign.chain.documents import flight_document, objective_families
from codesign.chain.flight import flight_seeds, flight_settings, joint_names, refusals
from codesign.chain.study import Study
from codesign.errors import StudyError
from codesign.robot.description import RobotDescription
from codesign.study import new_study
from codesign.study.config import LOAD_KINDS, StudyConfig
from codesign.study.loading import study_from

Place = tuple[str | int, ...]
# Of a load: one kind; of a part: one load case or several; of a change: a joint or a link.
EITHER = (
    *LOAD_KINDS, "face", "interface", "point_mm", "loads", "flown", "cases", "min", "max", "step", "values", "choices",
    "joint", "link",
)  # fmt: skip
PREDICTIVE = (  # of the other controller and its paths: not walked yet
    "mpc", "servo", "fuel", "jet_models", "waypoints", "kind", "rest_s", "duration_s", "pulses",
)  # fmt: skip
NAN, INFINITY = math.nan, math.inf
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
        "plant_step_s": 0.002,
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
        {"face": "seat", "bearing_n": [0.0, 9.0, 0.0]},
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
        "reaction_n_m_per_n": 0.01, "lag_s": [0.05, 0.05, 0.06, 0.06],
    }  # fmt: skip
    raw["flight"]["ground"]["height_m"] = 0.0
    raw["objectives"]["maximize"] = ["parts.strut.safety_factor"]
    raw["constraints"] |= {
        "body_clearance_min_mm": 1.0, "plume_clearance_min_mm": 1.0, "first_frequency_min_hz": 10.0,
        "buckling_factor_min": 2.0, "limits": {"flight.max_torque": {"min": 0.0, "max": 60.0}},
    }  # fmt: skip
    raw["optimizer"] |= {"algorithm": "nsga2", "crossover_probability": 0.9, "mutation_probability": 0.2, "seed": 1}
    raw["optimizer"]["evaluations"], raw["execution"]["lazy"] = 160, True


@pytest.fixture(scope="module")
def template(tmp_path_factory: pytest.TempPathFactory) -> tuple[dict[str, Any], Path]:
    """A study that gives every key of the configuration, and where its file would be."""
    folder = tmp_path_factory.mktemp("walk") / "study"
    new_study(folder)
    (folder / "rod.py").write_text(ROD)
    path = folder / "study.toml"
    raw = tomllib.loads(path.read_text() + WHOLE)
    complete(raw)
    return raw, path


def places(kind: kinds.Type, node: Any, place: Place = ()) -> Iterator[tuple[Place, kinds.Type]]:
    """Every key of the configuration where `node` has it, one entry of each list and table, with its type."""
    if isinstance(kind, kinds.UnionType):
        known = [other for other in kind.types if not isinstance(other, kinds.NoneType)]
        kind = next((k for k in known if isinstance(k, kinds.DictType) and isinstance(node, dict)), known[0])
    if place:
        yield place, kind
    if isinstance(kind, kinds.StructType):
        for field in kind.fields:
            if field.encode_name in (*EITHER, *PREDICTIVE) and field.encode_name not in node:
                continue
            assert field.encode_name in node, f"{place}: the template lacks {field.encode_name}"
            yield from places(field.type, node[field.encode_name], (*place, field.encode_name))
    elif isinstance(kind, kinds.DictType) and node:
        for key in list(node) if place == ("variables",) else list(node)[-1:]:
            yield from places(kind.value_type, node[key], (*place, key))
    elif isinstance(kind, kinds.TupleType):
        yield from places(kind.item_types[0], node[0], (*place, 0))
    elif isinstance(kind, kinds.CollectionType) and node:
        for index in range(len(node) if place[-1] == "loads" else 1):
            yield from places(kind.item_type, node[index], (*place, index))


def at(raw: Any, place: Place) -> Any:
    for step in place:
        raw = raw[step]
    return raw


def with_value(raw: dict[str, Any], place: Place, value: Any) -> dict[str, Any]:
    changed = copy.deepcopy(raw)
    at(changed, place[:-1])[place[-1]] = value
    return changed


def wrong_values(kind: kinds.Type, old: Any) -> list[Any]:
    """What people write there by mistake."""
    if isinstance(kind, kinds.FloatType | kinds.IntType):
        return ["text", NAN, INFINITY, -INFINITY, 0, -1, 10**400, [], [NAN], [1.0]]
    if isinstance(kind, kinds.BoolType):
        return ["true", 1, NAN]
    if isinstance(kind, kinds.StrType | kinds.LiteralType):
        return ["", 5, NAN, f"{old[:-1]}~{old[-1:]}"]
    if isinstance(kind, kinds.DictType | kinds.StructType):
        return [5, [], {}, {"no_such_key": 1}]
    return [5, {}, [], [NAN], ["no such name"], [[]]]


def fly(study: Study) -> None:
    """A flight of ten steps with everything that is written of it."""
    config = study.config
    for name in (config.flight.trajectory, "gusty"):
        if name in config.trajectories:
            settings = flight_settings(config.flight, config.trajectories[name])
            if settings.duration > 1.0:
                settings.duration = 10.0 * settings.step
            model = dyn.load_urdf(study.base_robot.to_text(), joints=joint_names(config.flight))
            seeds = flight_seeds(config, name)
            with refusals(study.path):
                logs = dyn.simulate_flights(model, settings, seeds)
            document = flight_document(name, logs, config.flight, 0.0, seeds)
            json.dumps([document, objective_families(logs)], allow_nan=False)


def test_every_key_is_accepted_or_refused_by_one_line(template, monkeypatch) -> None:
    raw, path = template
    monkeypatch.setattr(RobotDescription, "load", functools.cache(RobotDescription.load))
    study_from(raw, path, Study)
    walked = list(places(kinds.type_info(StudyConfig), raw))
    assert len({place for place, _ in walked}) > 180
    faults = []
    for place, kind in walked:
        for value in wrong_values(kind, at(raw, place)):
            try:
                study = study_from(with_value(raw, place, value), path, Study)
                if not sensible(value):
                    faults.append(f"{place} = {value!r} was accepted")
                fly(study)
            except StudyError as error:
                if not helps(str(error), path, place, value):
                    faults.append(f"{place} = {value!r}: {error}")
            except Exception as error:
                faults.append(f"{place} = {value!r}: {type(error).__name__}: {error}")
    assert not faults, "\n".join(faults)


def helps(message: str, path: Path, place: Place, value: Any) -> bool:
    """Whether it is one line with the file and the key (or the table, if that is at fault), and says what is there."""
    keys = [str(step) for step in place if isinstance(step, str)]
    return (
        message.startswith(f"{path}: ")
        and "\n" not in message
        and len(message) < len(str(path)) + 400
        and any(key in message for key in keys[-2:])
        and (sensible(value) or repr(value)[:20] in message)
    )


def sensible(value: Any) -> bool:
    """Whether a number is one that a study may hold."""
    return not isinstance(value, int | float) or (math.isfinite(value) if isinstance(value, float) else value < 1e100)


@pytest.mark.parametrize(
    ("place", "near"),
    [
        (("parts", 0, "supports", 0), "mount"),
        (("parts", 0, "cases", 0, "loads", 0, "face"), "seat"),
        (("parts", 0, "material"), "ergal"),
        (("parts", 0, "parameters", "reach"), "reach"),
        (("parts", 0, "placements", 0, "link"), "front_strut"),
        (("parts", 0, "placements", 0, "joints", "front_roll", "interface"), "jet"),
        (("parts", 0, "shape"), "Strut"),
        (("flight", "trajectory"), "climb_and_turn"),
        (("flight", "joint_groups", 0, "joints", 0), "front_roll"),
        (("flight", "jets", "frames", 0), "front_jet"),
        (("flight", "jets", "symmetric_pairs", 0, 0), "front_jet"),
        (("flight", "ground", "frames", 0), "skid_front"),
        (("flight", "jet_model"), "turbine"),
        (("fem", "load"), "uniform"),
        (("fem", "support"), "published"),
        (("fem", "accuracy"), "optimization"),
        (("interference", "bodies", 0), "front_strut"),
        (("interference", "ignore", 0, 1), "left_strut"),
        (("interference", "plumes", "jets", 0), "front_jet"),
        (("validation", "trajectories", 0), "descend_backwards"),
        (("objectives", "minimize", 0), "momentum"),
        (("objectives", "family"), "rms"),
        (("variables", "gain", "sets", 0), "flight.gains.attitude_proportional"),
    ],
)
def test_a_misspelt_name_is_answered_by_the_nearest_one(template, place, near) -> None:
    raw, path = template
    old = at(raw, place)
    assert near in old
    wrong = old.replace(near, near[:-2] + near[-1])
    with pytest.raises(StudyError) as refused:
        study_from(with_value(raw, place, wrong), path, Study)
    message = str(refused.value)
    assert (near[:-2] + near[-1] in message and repr(near) in message) or f"there are {near}" in message, message


def test_a_misspelt_key_is_answered_by_the_nearest_one(template) -> None:
    raw, path = template
    for place, kind in places(kinds.type_info(StudyConfig), raw):
        table = at(raw, place[:-1])
        if not isinstance(table, dict) or isinstance(kind, kinds.AnyType) or _in_free_table(place):
            continue
        wrong = copy.deepcopy(raw)
        holder, key = at(wrong, place[:-1]), str(place[-1])
        holder[f"{key}s" if len(key) < 4 else key[:-2] + key[-1]] = holder.pop(key)
        with pytest.raises(StudyError) as refused:
            study_from(wrong, path, Study)
        assert repr(key) in str(refused.value) or f"there are {key}" in str(refused.value), (place, refused.value)


def _in_free_table(place: Place) -> bool:
    """Whether the last key is a name that the study's author chose."""
    return "choices" in place[-3:-1] or (len(place) > 1 and place[-2] in (
        "variables", "baseline", "materials", "trajectories", "parameters", "options", "joints", "limits",
    ))  # fmt: skip


@pytest.mark.parametrize(
    "values",
    [
        {("fem", "exclusion_distance_mm"): 0.0, ("materials", "steel", "poisson_ratio"): 0.0},
        {
            ("parts", 0, "loads", 0, "pressing_n"): -50.0,
            ("trajectories", "climb_and_turn", "windows"): [],
            ("flight", "weights", "momentum"): 0.0,
        },
    ],
)
def test_what_is_accepted_can_be_evaluated(template, values) -> None:
    raw, path = template
    small = raw | {"parts": raw["parts"][1:], "objectives": {}, "constraints": {}, "interference": None}
    for place, value in values.items():
        small = with_value(small, place, value)
    study = study_from(small, path, Study)
    evaluation = study.evaluate(study.baseline or {})
    assert evaluation.status in ("feasible", "infeasible"), evaluation.reason
    evaluation.to_json()
