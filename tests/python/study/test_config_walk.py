"""Every field of study.toml in turn with what people get wrong: flown, or refused by one line that helps."""

import copy
import functools
import json
import math
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
from codesign.study.config import StudyConfig
from codesign.study.load_config import LOAD_KINDS
from codesign.study.loading import study_from
from whole_study import predictive, write_whole_study

Place = tuple[str | int, ...]
# Of a load: one kind; of a part: one load case or several; of a change: a joint or a link, stretched or scaled.
EITHER = (
    *LOAD_KINDS, "face", "interface", "point_mm", "loads", "flown", "cases", "min", "max", "step", "values", "choices",
    "joint", "link", "reference_mm",
)  # fmt: skip
ONE_CONTROLLER = (  # has them; the other's study does without
    "mpc", "servo", "fuel", "jet_models", "waypoints", "kind", "rest_s", "duration_s", "pulses", "windows",
    "drives", "drag", "tank", "viscous_friction_n_m_per_rad_s", "coulomb_friction_n_m",
)  # fmt: skip
NAN, INFINITY = math.nan, math.inf


@pytest.fixture(scope="module")
def template(tmp_path_factory: pytest.TempPathFactory) -> tuple[dict[str, Any], Path]:
    """A study that gives every key of the configuration, and where its file would be."""
    return write_whole_study(tmp_path_factory.mktemp("walk") / "study")


def places(kind: kinds.Type, node: Any, place: Place = ()) -> Iterator[tuple[Place, kinds.Type]]:
    """Every key of the configuration where `node` has it, one entry of each list and table, with its type."""
    if isinstance(kind, kinds.UnionType):
        known = [other for other in kind.types if not isinstance(other, kinds.NoneType)]
        kind = next((k for k in known if isinstance(k, kinds.DictType) and isinstance(node, dict)), known[0])
    if place:
        yield place, kind
    if isinstance(kind, kinds.StructType):
        for field in kind.fields:
            if field.encode_name in (*EITHER, *ONE_CONTROLLER) and field.encode_name not in node:
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


def faults(walked: list[tuple[Place, kinds.Type]], raw: dict[str, Any], path: Path) -> Iterator[str]:
    """What is neither flown nor refused by one line that helps."""
    for place, kind in walked:
        for value in wrong_values(kind, at(raw, place)):
            try:
                study = study_from(with_value(raw, place, value), path, Study)
                if not sensible(value):
                    yield f"{place} = {value!r} was accepted"
                fly(study)
            except StudyError as error:
                if not helps(str(error), path, place, value):
                    yield f"{place} = {value!r}: {error}"
            except Exception as error:
                yield f"{place} = {value!r}: {type(error).__name__}: {error}"


def test_every_key_is_accepted_or_refused_by_one_line(template, monkeypatch) -> None:
    raw, path = template
    monkeypatch.setattr(RobotDescription, "load", functools.cache(RobotDescription.load))
    study_from(raw, path, Study)
    walked = list(places(kinds.type_info(StudyConfig), raw))
    assert len({place for place, _ in walked}) > 180
    found = list(faults(walked, raw, path))
    assert not found, "\n".join(found)


def test_so_is_every_key_of_the_other_controller(template, monkeypatch) -> None:
    raw, path = template
    monkeypatch.setattr(RobotDescription, "load", functools.cache(RobotDescription.load))
    other = predictive(raw)
    fly(study_from(other, path, Study))
    known = {place for place, _ in places(kinds.type_info(StudyConfig), raw)}
    walked = [(place, kind) for place, kind in places(kinds.type_info(StudyConfig), other) if place not in known]
    keys = {step for place in known | {place for place, _ in walked} for step in place}
    assert set(ONE_CONTROLLER) <= keys
    found = list(faults(walked, other, path))
    assert not found, "\n".join(found)


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
