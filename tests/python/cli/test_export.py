"""An export is an order: how many of what, of which material, in which units; never over another design's files."""

import csv
import dataclasses
import json
from pathlib import Path

import msgspec
import mujoco
import pyarrow.parquet as parquet
import pytest

import synthetic_run
from codesign.chain.study import load_study
from codesign.cli.export.design import ChosenDesign, design_of_run, export_design, unplaced
from codesign.cli.export.folder import MANIFEST, export_folder
from codesign.cli.export.formats import CAD, DEFAULT, FORMATS, parse_formats, parse_frames, units_of
from codesign.errors import CodesignError, DesignError, ExportError, LibraryError
from codesign.parts.step import SCHEMAS
from codesign.report.verdict import Verdict
from vtu_files import read_vtu

DESIGN = {"angle": 15, "distance": 42, "offset": 80, "length": 108}
KINDS = (*DEFAULT, "mjcf", "sdf", "parquet")
PARTS = {"jetpack_bracket": 2, "forearm_support": 1, "forearm_support_mirrored": 1}


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("export") / "order"
    study = load_study("ironcub_paper")
    chosen = ChosenDesign(study, DESIGN, "design 7 of a", lambda _: Verdict("candidate", "design 7", ("It is new.",)))
    written = export_design(study, DESIGN, folder, run=chosen, organization="workshop", formats=KINDS)
    assert sorted(written) == sorted(path for path in folder.rglob("*") if path.is_file())
    assert not list(folder.parent.glob(".*"))
    return folder


def test_the_manifest_says_what_to_make(out: Path) -> None:
    manifest = json.loads((out / MANIFEST).read_text())
    assert {part["name"]: part["quantity"] for part in manifest["parts"]} == PARTS
    assert manifest["design"]["distance"] == {"value": 42, "unit": "mm"}
    assert manifest["chosen"] == "design 7 of a"
    assert manifest["verdict"]["reasons"] == ["It is new."]
    assert manifest["units"]["cad/*.stl"] == "mm"
    assert manifest["files"] == sorted(str(path.relative_to(out)) for path in out.rglob("*") if path.is_file())
    bracket, forearm, mirrored = manifest["parts"]
    assert bracket["material"]["name"] == "ergal"
    assert bracket["density_kg_m3"] == 2800.0
    assert bracket["load_case"]["supports"] == ["mount"]
    assert forearm["density_kg_m3"] == mirrored["density_kg_m3"] == 4410.0
    assert mirrored["mirror_image_of"] == "forearm_support"
    evaluation = json.loads((out / "evaluation.json").read_text())
    for part in (bracket, forearm):
        assert part["mass"] == evaluation["parts"][part["name"]]["mass"]
        assert part["strength"]["safety_factor"] == evaluation["parts"][part["name"]]["safety_factor"]


def test_the_bill_of_materials_is_a_table(out: Path) -> None:
    with (out / "bom.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert {row["part"]: int(row["quantity"]) for row in rows} == PARTS
    for row in rows:
        assert float(row["mass_total_kg"]) == pytest.approx(float(row["mass_each_kg"]) * int(row["quantity"]), rel=1e-5)
        assert (out / row["step"]).is_file()
        assert (out / row["stl"]).is_file()


def test_the_page_names_materials_loads_and_units(out: Path) -> None:
    page = (out / "README.md").read_text()
    for words in (
        "ergal, 4410 kg/m³",
        "pressing on face seat",
        "| distance | 42 | mm |",
        "| `cad/*.stl` | mm |",
        "threads",
    ):
        assert words in page
    assert "belong to the author of the study" in page
    assert "**Candidate: design 7. Not to be built yet:**\n\n- It is new." in page


def test_step_files_carry_revision_and_organization(out: Path) -> None:
    revision = json.loads((out / MANIFEST).read_text())["revision"]
    for name in (*PARTS, "assembly"):
        text = (out / "cad" / f"{name}.step").read_text()
        assert f"PRODUCT_DEFINITION_FORMATION('{revision}'," in text
        assert "'workshop'" in text
    assert "AP242" in SCHEMAS


def test_stress_files_name_their_model(out: Path) -> None:
    names = {path.name for path in (out / "stress").iterdir()}
    assert names == {
        "jetpack_bracket_simplified_half.vtu",
        "jetpack_bracket_simplified_whole.vtu",
        "forearm_support_simplified.vtu",
    }
    half, whole = (read_vtu(out / "stress" / f"jetpack_bracket_simplified_{kind}.vtu") for kind in ("half", "whole"))
    assert half.strings["model"] == "simplified geometry, 1/2 of the symmetric part"
    assert whole.strings["model"].endswith("and its mirror image")
    assert half.points[:, 1].min() > -1e-9
    assert whole.points[:, 1].min() == pytest.approx(-whole.points[:, 1].max(), rel=1e-9)
    assert len(whole.cells) == 2 * len(half.cells)
    assert "N pressing on face seat" in half.strings["load_case"]
    numbers = json.loads((out / "evaluation.json").read_text())["parts"]["jetpack_bracket"]
    for file in (half, whole):
        counted = file.point_data["von_mises"][file.point_data["counts_for_peak"] == 1]
        assert 0.95 * numbers["peak_stress"] < counted.max() < 1.001 * numbers["peak_stress"]
        assert file.point_data["von_mises"].max() > 2.0 * numbers["peak_stress"]  # beside the clamp


def test_the_robot_flies_elsewhere_from_the_files_alone(out: Path) -> None:
    robot = json.loads((out / "robot" / "robot.json").read_text())
    evaluation = json.loads((out / "evaluation.json").read_text())
    assert robot["objectives"] == evaluation["objectives"]
    assert robot["design"] == DESIGN
    assert [jet["frame"] for jet in robot["jets"]][:2] == ["l_arm_jet_turbine", "r_arm_jet_turbine"]
    for jet in robot["jets"]:
        assert jet["axis"] == [0.0, 0.0, -1.0]
        assert (jet["thrust_min"], jet["thrust_max"], jet["thrust_rate_max"]) == (0.0, 250.0, 200.0)
        assert jet["dynamics"] == {"kind": "integrator", "command": "thrust rate [N/s]"}
    assert robot["joints_held"] == ["neck_pitch", "neck_roll", "neck_yaw"]
    assert robot["start"]["joints"]["l_elbow"] == 0.2618
    assert robot["start"]["base_position"] == [0.0, 0.0, 0.8]
    assert robot["plant"] == {"integrator": "euler", "substeps": 1}
    gains = robot["controller"]["gains"]
    assert gains["attitude_proportional"] == 50.0
    assert len(gains["posture"]) == len(robot["joints"]) == 23
    model = mujoco.MjModel.from_xml_path(str(out / "robot" / "robot.xml"))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("start").id)
    mujoco.mj_forward(model, data)
    assert data.ncon == 0
    assert robot["mass"] == pytest.approx(model.body_subtreemass[1], rel=1e-14)
    flight = parquet.read_table(out / "robot" / "flight.parquet")
    assert flight.num_rows == 5251
    assert flight.schema.metadata[b"angle"] == b"15"
    assert (out / "robot" / "robot.srdf").is_file()
    page = (out / "README.md").read_text()
    assert "`robot/robot.xml`: the same for MuJoCo" in page
    assert "flight.csv" not in page


def test_formats_by_name() -> None:
    assert parse_formats(",".join(DEFAULT)) == tuple(kind for kind in FORMATS if kind in DEFAULT)
    assert parse_formats("all") == FORMATS
    assert parse_formats(" STL, log,stl") == ("stl", "csv", "parquet")
    with pytest.raises(ExportError, match="no format 'mjfc'; did you mean 'mjcf'"):
        parse_formats("stl,mjfc")
    with pytest.raises(ExportError, match="name at least one"):
        parse_formats(" ,")
    assert "robot/flight.*" not in units_of(DEFAULT, ["cad/a.stl", "robot/robot.urdf"])
    assert "robot/*" not in units_of(DEFAULT, ["cad/a.stl"])  # parts alone have no robot
    assert set(units_of(("csv",), ["robot/flight.csv"])) == {"robot/flight.*", "evaluation.json", "bom.csv"}
    assert set(CAD) < set(FORMATS)


def test_frames_by_name() -> None:
    assert parse_frames("tiny") == "tiny"
    with pytest.raises(ExportError, match="--frames: 'none' is none of keep, drop, tiny"):
        parse_frames("none")


def test_a_missing_library_is_said_before_anything_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    with pytest.raises(LibraryError, match=r"parquet needs pyarrow, .*codesign\[analysis\]"):
        parse_formats("log")
    assert parse_formats("csv") == ("csv",)


def test_only_the_formats_asked_for(tmp_path: Path) -> None:
    study = load_study("gimbal_quad")
    out = tmp_path / "order"
    files = export_design(study, {"reach": 200, "height": 30}, out, formats=("stl", "csv"))
    names = {str(path.relative_to(out)) for path in files}
    assert names == {
        "cad/strut.stl",
        "robot/flight.csv",
        "robot/robot.json",
        *("README.md", "bom.csv", "evaluation.json", MANIFEST),
    }
    (row,) = csv.DictReader((out / "bom.csv").read_text().splitlines())
    assert (row["step"], row["stl"]) == ("", "cad/strut.stl")
    page = (out / "README.md").read_text()
    for absent in (".3mf", ".step", "robot.urdf", ".vtu", ".glb"):
        assert absent not in page


def test_known_numbers_are_not_computed_again_where_no_field_is_asked_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    study, design = load_study("gimbal_quad"), {"reach": 210, "height": 30}
    export_design(study, design, tmp_path / "first", formats=("stl", "urdf"))
    monkeypatch.setattr("codesign.cli.export.design.evaluate_with_fields", None)
    export_design(study, design, tmp_path / "second", formats=("stl", "urdf", "csv"))
    first, second = ((tmp_path / name / "evaluation.json").read_text() for name in ("first", "second"))
    assert first == second
    assert (tmp_path / "second" / "robot" / "flight.csv").is_file()


def test_a_part_without_a_place_is_made_once() -> None:
    study = load_study("ironcub_paper")
    bracket, forearm = study.config.parts
    config = msgspec.structs.replace(study.config, parts=[msgspec.structs.replace(bracket, placements=[]), forearm])
    parts = study.build_parts(DESIGN)
    (component,) = unplaced(dataclasses.replace(study, config=config), parts)
    assert component.part is parts["jetpack_bracket"]
    assert unplaced(study, parts) == []


def test_another_design_is_never_overwritten_silently(out: Path, tmp_path: Path) -> None:
    other = {**DESIGN, "angle": 16}
    before = (out / MANIFEST).read_bytes()
    with pytest.raises(ExportError, match=r"holds revision \w+ of study ironcub_paper \(angle = 15, .*--force"):
        export_design(load_study("ironcub_paper"), other, out)
    assert (out / MANIFEST).read_bytes() == before
    (tmp_path / "notes.txt").write_text("mine")
    with pytest.raises(ExportError, match="not empty and holds no export"):
        export_design(load_study("ironcub_paper"), DESIGN, tmp_path)
    with pytest.raises(ExportError, match="is a file"):
        export_design(load_study("ironcub_paper"), DESIGN, tmp_path / "notes.txt")


def write(folder: Path, revision: str, *files: str, force: bool = False) -> None:
    with export_folder(folder, revision, force) as work:
        for file in files:
            (work / file).parent.mkdir(exist_ok=True)
            (work / file).write_text(revision)
        (work / MANIFEST).write_text(json.dumps({"revision": revision, "files": [*files, MANIFEST, "../outside"]}))


def contents(folder: Path) -> dict[str, str]:
    return {str(p.relative_to(folder)): p.read_text() for p in folder.rglob("*") if p.is_file() and p.name != MANIFEST}


def test_the_same_design_and_force_replace_an_export(tmp_path: Path) -> None:
    folder = tmp_path / "order"
    (tmp_path / "outside").write_text("kept")
    write(folder, "a", "cad/x.stl", "cad/y.stl")
    write(folder, "a", "cad/x.stl")
    assert contents(folder) == {"cad/x.stl": "a"}
    (folder / "mine.txt").write_text("mine")
    with pytest.raises(ExportError, match="holds revision a, not this design"):
        write(folder, "b", "cad/z.stl")
    write(folder, "b", "cad/z.stl", force=True)
    assert contents(folder) == {"cad/z.stl": "b", "mine.txt": "mine"}
    assert (tmp_path / "outside").read_text() == "kept"


def test_a_failed_export_leaves_the_earlier_one(tmp_path: Path) -> None:
    write(tmp_path / "order", "a", "x")
    with pytest.raises(CodesignError, match="no mesh"), export_folder(tmp_path / "order", "a") as work:
        (work / "x").write_text("half")
        raise CodesignError("no mesh")
    assert contents(tmp_path) == {"order/x": "a"}
    (tmp_path / "file").write_text("")
    with pytest.raises(ExportError, match="cannot be written"):
        write(tmp_path / "file" / "order", "a", "x")


def test_a_design_of_a_run(tmp_path: Path) -> None:
    synthetic_run.write_run(tmp_path / "a", synthetic_run.evaluations(40), study=load_study("ironcub_paper"))
    chosen = design_of_run(tmp_path / "a", "recommended")
    assert chosen.study.name == "ironcub_paper"
    assert chosen.words.endswith("of a (recommended)")
    number = chosen.words.split()[1]
    assert design_of_run(tmp_path / "a", number).design == chosen.design
    for selector, message in (("9999", "no design 9999"), ("front", "one design is needed"), ("knee1", "names no")):
        with pytest.raises(DesignError, match=message):
            design_of_run(tmp_path / "a", selector)
