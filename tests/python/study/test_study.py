"""Studies: strict configuration, cross-checks, hash, generality."""

import tomllib

import pytest

from codesign.chain.study import load_study
from codesign.errors import StudyError
from codesign.robot.table import generated_urdf
from codesign.storage.cache import MemoryCache
from codesign.study import new_study, shipped_studies
from codesign.study.loading import STUDIES

BASELINE = "# The design that reports compare with.\n[baseline]"


def variable(name: str, minimum: int, maximum: int, step: int, sets: str, baseline: int) -> str:
    """Text that puts a design variable which sets a number of the study before the baseline."""
    bounds = f"min = {minimum}\nmax = {maximum}\nstep = {step}"
    return f'[variables.{name}]\n{bounds}\nsets = ["{sets}"]\n\n[baseline]\n{name} = {baseline}'


GAIN = variable("gain", 20, 80, 5, "flight.gains.attitude_proportional", 50)
DENSITY = variable("density", 2000, 4000, 1000, "materials.ergal.density_kg_m3", 3000)


@pytest.fixture
def copy(tmp_path):
    """A writable copy of the small shipped study, and a function that loads it after a text replacement."""
    folder = tmp_path / "study"
    new_study(folder)

    def edited(old: str, new: str):
        file = folder / "study.toml"
        text = file.read_text()
        assert old in text
        file.write_text(text.replace(old, new, 1))
        return load_study(folder)

    return edited


def test_shipped_studies_load():
    assert shipped_studies() == [
        "gimbal_quad", "hexarotor", "ironcub", "ironcub_paper", "ironcub_retuned", "ironcub_robust",
        "ironcub_strength", "ironcub_whole",
    ]  # fmt: skip
    for name in shipped_studies():
        assert load_study(name).baseline is not None


def test_paper_grid():
    assert load_study("ironcub_paper").space.levels == (79, 31, 21, 51)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "[variables.reach]",
            "[variables.reach]\ncolor = 3",
            r"study.toml: variables.reach: unknown key 'color'; there are min, max, step",
        ),
        ("min = 120", "min = 400", "variables.reach: max = 320 must be above min = 400"),
        ("step = 10", "step = 7", "variables.reach.step: 7 does not divide"),
        ("step = 10", "step = -10", r"variables.reach.step: -10: expected `float` > 0"),
        ('unit = "mm"', 'unit = "cm"', "variables.reach.unit: 'cm' is not possible; there are '', deg, mm"),
        ('unit = "mm"', 'unit = "deg"', "variables.reach.unit: strut:Strut expects 'mm' for reach"),
        (
            'shape = "strut:Strut"',
            'shape = "strut:Beam"',
            "parts.strut.shape = 'strut:Beam': 'Beam' is not in strut; there are Strut",
        ),
        ('shape = "strut:Strut"', 'shape = "absent:Beam"', "parts.strut.shape = 'absent:Beam'"),
        ('material = "ergal"', 'material = "unobtainium"', "parts.strut.material: .*'unobtainium'"),
        ('trajectory = "climb_and_turn"', 'trajectory = "loop"', "flight.trajectory: no trajectory 'loop'"),
        ("to_s = 6", "to_s = 2", "trajectories.climb_and_turn.windows: to_s = 2 is not after 3"),
        ("reach = 200", "reach = 205", "baseline: reach = 205 mm: off the grid"),
        ("duration_s = 20.0", 'duration_s = "20"', "flight.duration_s: '20' is a text; write the number without"),
        ("[robot]", "[robot", "not valid TOML"),
        ("velocity_weight = 1.0", "velocity_weight = 1.0\nrange_scale = nan", "range_scale: nan is not a finite"),
        ("max_thrust_n = 250.0", "max_thrust_n = inf", "flight.jets.max_thrust_n: inf is not a finite"),
        ("max = 320", "max = nan", "variables.reach.max: nan is not a finite"),
        ("min = 120", "min = -inf", "variables.reach.min: -inf is not a finite"),
        ("step = 10", "step = 1e-300", "variables.reach.step: 1e-300 gives more than 1000000 values"),
        ('supports = ["mount"]', "supports = []", "parts.strut.supports: empty"),
        ('supports = ["mount"]', 'supports = ["mont"]', "parts.strut.supports: no face 'mont'; did you mean 'mount'"),
        ('face = "seat"', 'face = "foot"', "parts.strut.loads: no face 'foot'; .*seat"),
        ('face = "seat"', 'face = "mount"', "parts.strut.loads: the load acts on 'mount', which is held"),
        (
            'material = "ergal"',
            'material = "ergal"\noptions = { heigth = 3 }',
            "options: no option of strut:Strut 'heigth'",
        ),
        ('interface = "jet"', 'interface = "jett"', "joints.front_roll: no interface 'jett'; did you mean 'jet'"),
        ('link = "front_strut"', 'link = "front_strutt"', "placements: no link 'front_strutt'; did you mean 'front_st"),
        (
            '"front_roll", "front_pitch"',
            '"front_role", "front_pitch"',
            "moving joint 'front_role'; did you mean 'front_roll'",
        ),
        ('frames = ["front_jet"', 'frames = ["front_jed"', "flight.jets.frames: no link 'front_jed'; did you mean"),
        ('frames = ["skid_front"', 'frames = ["skid_frond"', "flight.ground.frames: no link 'skid_frond'"),
        ("step_s = 0.008", "step_s = 0.007", "flight.duration_s: 20 is not a whole number of steps of 0.007 s"),
        ("[flight.gains]", "[flight.gain]", r"flight: unknown key 'gain'; did you mean 'gains'|'gains' is missing"),
        ("population = 16", "poulation = 16", "optimizer: unknown key 'poulation'; did you mean 'population'"),
        (
            "safety_factor_min",
            "body_clearance_min_mm = 3\nsafety_factor_min",
            r"body_clearance_min_mm: needs .*interfer",
        ),
    ],
)
def test_wrong_studies_are_refused_with_file_key_and_reason(copy, old, new, message):
    with pytest.raises(StudyError, match=message):
        copy(old, new)


def test_missing_study_names_the_shipped_ones():
    with pytest.raises(StudyError, match="shipped studies: gimbal_quad, hexarotor, ironcub, ironcub_paper"):
        load_study("nowhere")


def test_hash_follows_what_decides_results(copy, tmp_path):
    first = load_study(tmp_path / "study").hash
    assert copy("population = 16", "population = 17").hash == first
    assert copy("title = ", "# \ntitle = ").hash == first
    assert copy("tolerance = 0.05", "tolerance = 0.04").hash != first


def test_hash_follows_the_part_source(copy, tmp_path):
    first = load_study(tmp_path / "study").hash
    source = tmp_path / "study" / "strut.py"
    source.write_text(source.read_text() + "\n# thicker\n")
    assert copy("population = 16", "population = 18").hash != first


def test_a_number_of_the_study_can_be_a_design_variable(copy):
    study = copy(BASELINE, GAIN)
    assert study.config.flight.gains.attitude_proportional == 50.0
    configured = study.configured({"reach": 200, "height": 30, "gain": 35})
    assert configured.flight.gains.attitude_proportional == 35.0


@pytest.mark.parametrize(("text", "values", "shared"), [(GAIN, (35, 50), True), (DENSITY, (2000, 4000), False)])
def test_a_part_is_taken_from_the_cache_only_if_nothing_of_its_own_changed(copy, text, values, shared):
    study = copy(BASELINE, text)
    name = study.space.variables[-1].name
    cache = MemoryCache()
    first, second = (study.evaluate({"reach": 200, "height": 30, name: value}, cache=cache) for value in values)
    assert first.status != "failed", first.reason
    assert (first.parts == second.parts) is shared
    if not shared:
        assert second.parts["strut"]["mass"] == pytest.approx(2.0 * first.parts["strut"]["mass"], rel=1e-12)


def test_parts_of_studies_that_fly_differently_are_the_same_parts(copy):
    first = copy("attitude_proportional = ", "attitude_proportional = 0.5e1 # ")
    cache = MemoryCache()
    parts = first.evaluate({"reach": 200, "height": 30}, cache=cache).parts
    second = copy("attitude_proportional = 0.5e1", "attitude_proportional = 0.6e1")
    assert second.hash != first.hash
    assert second.evaluate({"reach": 200, "height": 30}, cache=cache).parts == parts  # times included: not done again


def test_a_variable_that_sets_nothing_real_is_refused(copy):
    with pytest.raises(StudyError, match=r"sets = 'flight.gains.atitude': no such number.*'flight.gains.attitude"):
        copy("[baseline]", variable("gain", 2, 8, 2, "flight.gains.atitude", 2))
    with pytest.raises(StudyError, match="does not enter an evaluation"):
        copy("flight.gains.atitude", "optimizer.population")


def test_new_study_refuses_a_folder_in_use(tmp_path):
    (tmp_path / "file").write_text("x")
    with pytest.raises(StudyError, match="not empty"):
        new_study(tmp_path)


@pytest.mark.parametrize("name", [name for name in shipped_studies() if (STUDIES / name / "robot.urdf").exists()])
def test_shipped_urdf_is_that_of_its_table(name):
    assert generated_urdf(STUDIES / name / "robot.toml") == (STUDIES / name / "robot.urdf").read_text()


def test_engine_names_no_robot():
    """The engine's sources know nothing of the shipped study's robot."""
    words = ("l_forearm", "chest_l", "l_elbow", "turbine_seat")
    study_files = {p for name in shipped_studies() for p in (STUDIES / name).rglob("*")}
    for file in STUDIES.parent.rglob("*.py"):
        if file not in study_files:
            text = file.read_text().lower()
            assert not [word for word in words if word in text], file


def test_study_files_are_valid_toml():
    for name in shipped_studies():
        assert tomllib.loads((STUDIES / name / "study.toml").read_text())["name"] == name


def test_a_study_may_begin_with_a_byte_order_mark_and_have_windows_lines(tmp_path):
    new_study(tmp_path / "plain")
    new_study(tmp_path / "windows")
    path = tmp_path / "windows" / "study.toml"
    path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes().replace(b"\n", b"\r\n"))
    assert load_study(path).hash == load_study(tmp_path / "plain").hash


def test_a_module_that_exits_is_told(tmp_path):
    new_study(tmp_path / "study")
    (tmp_path / "study" / "strut.py").write_text("raise SystemExit(3)\n")
    with pytest.raises(StudyError, match=r"parts.strut.shape = 'strut:Strut': SystemExit: 3"):
        load_study(tmp_path / "study")
