"""Designs of a run on other trajectories; tables for other programs; lists and comparisons of runs."""

import csv

import pytest

from codesign.errors import StoreError
from codesign.followup.reevaluate import revisit
from codesign.search.optimization import optimize, resume
from codesign.storage.runs import compare_runs, list_runs, load_run
from codesign.storage.tables import export
from fake_study import study


def test_validates_the_front_and_keeps_the_search_as_it_was(tmp_path) -> None:
    log = tmp_path / "log"
    fake = study(log=str(log))
    run = optimize(fake, out=tmp_path / "run", cache=None, generations=2)
    records = revisit(tmp_path / "run", ["hover", "walk"])
    assert [record.grid for record in records[::2]] == [record.grid for record in run.front]
    assert {record.evaluation.flight["trajectory"] for record in records} == {"hover", "walk"}
    lines = log.read_text().splitlines()
    again = revisit(tmp_path / "run", ["hover", "walk"])
    assert again == records
    assert log.read_text().splitlines() == lines
    after = load_run(tmp_path / "run")
    assert after.search_records == run.search_records
    assert len(after.records) == 16 + len(records)
    assert resume(tmp_path / "run", evaluations=24).search_records[:16] == run.search_records


def test_validates_given_designs(tmp_path) -> None:
    optimize(study(), out=tmp_path / "run", cache=None, generations=1)
    design = {"a": 1.5, "b": 1.0, "c": 0.5}
    (record,) = revisit(tmp_path / "run", ["hover"], [design], cache=None)
    assert record.evaluation.design == design
    assert record.number is None


def test_tables_hold_every_number_exactly(tmp_path) -> None:
    from pyarrow import parquet

    run = optimize(study(faults={"3,3,3": "raise"}), out=tmp_path / "run", cache=None, generations=2)
    with export(run, tmp_path / "rows.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    columns = parquet.read_table(export(run, tmp_path / "rows.parquet")).to_pydict()
    assert len(rows) == len(columns["a"]) == len(run.records) == 16
    for i, record in enumerate(run.records):
        near = record.evaluation.objectives.get("near")
        assert columns["objectives.near"][i] == near
        assert rows[i]["objectives.near"] == ("" if near is None else repr(near))
        assert float(rows[i]["b"]) == columns["b"][i] == record.evaluation.design["b"]
        assert rows[i]["status"] == record.evaluation.status
    with pytest.raises(StoreError, match=r"as \.csv or \.parquet"):
        export(run, tmp_path / "rows.xlsx")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["rows.csv", "rows.parquet", "run"]


def test_lists_and_compares_runs(tmp_path) -> None:
    good = optimize(study(), out=tmp_path / "good", cache=None, generations=6)
    poor = optimize(study(), out=tmp_path / "poor", cache=None, generations=1, algorithm="random")
    (tmp_path / "broken").mkdir()
    (tmp_path / "broken" / "run.sqlite").write_bytes(b"nonsense" * 100)
    broken, first, second = list_runs(tmp_path)
    assert "not a database" in broken["error"]
    assert [first["designs"], second["designs"]] == [48, 8]
    assert first["outcome"] == "budget used up"
    better, worse = compare_runs([good, poor])
    assert better["hypervolume"] > worse["hypervolume"] > 0.0
    assert 0 < better["non_dominated"] <= len(good.front)
    (alone,) = compare_runs([good])
    assert alone["non_dominated"] == len(good.front)
