"""`codesign new`: copies of shipped studies are studies of their own."""

import pytest
from typer.testing import CliRunner

from codesign import load_study
from codesign.cli.main import app
from codesign.errors import StudyError
from codesign.study import new_study, shipped_studies


@pytest.mark.parametrize("name", shipped_studies())
def test_the_copy_of_a_shipped_study_says_the_same_without_the_package(tmp_path, name):
    files = new_study(tmp_path / "mine", name)
    copy, shipped = load_study(tmp_path / "mine"), load_study(name)
    for file in files:
        if file.suffix in (".toml", ".py"):
            assert "codesign.studies" not in file.read_text()
    assert {path.parent for path in files} == {tmp_path / "mine"}
    assert copy.space.levels == shipped.space.levels
    assert copy.config.flight == shipped.config.flight
    assert copy.config.constraints == shipped.config.constraints
    for mine, theirs in zip(copy.config.parts, shipped.config.parts, strict=True):
        assert mine.shape == theirs.shape.removeprefix("codesign.studies.ironcub.")
        assert (mine.load_cases, mine.masses, mine.placements) == (theirs.load_cases, theirs.masses, theirs.placements)
    if shipped.baseline is not None:
        assert copy.build_robot(copy.baseline) == shipped.build_robot(shipped.baseline)


def test_an_extending_study_keeps_its_bases_and_their_comments_beside_it(tmp_path):
    new_study(tmp_path / "mine", "ironcub")
    assert (tmp_path / "mine" / "ironcub_paper.toml").is_file()
    text = (tmp_path / "mine" / "study.toml").read_text()
    assert '\nextends = "ironcub_robust.toml"\n' in text
    assert text.startswith("# Jet interfaces")
    base = tmp_path / "mine" / "ironcub_paper.toml"
    base.write_text(base.read_text().replace("duration_s = 42.0", "duration_s = 41.0"))
    assert load_study(tmp_path / "mine").config.flown.duration_s == 41.0


def test_what_cannot_be_copied_is_refused(tmp_path):
    with pytest.raises(StudyError, match="no shipped study 'hexarotr'; did you mean 'hexarotor'"):
        new_study(tmp_path / "mine", "hexarotr")
    assert not (tmp_path / "mine").exists()
    run = CliRunner().invoke(app, ["new", str(tmp_path / "dog"), "--from", "hexarotor", "--urdf", "x.urdf"])
    assert run.exit_code != 0
    run = CliRunner().invoke(app, ["new", str(tmp_path / "six"), "--from", "hexarotor"])
    assert run.exit_code == 0
    assert (tmp_path / "six" / "arm.py").is_file()
