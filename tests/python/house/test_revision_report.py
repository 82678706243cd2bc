"""What benchmarks/against_revision.sh says of two sets of results."""

import importlib.util
import json
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[3]
SPEC = importlib.util.spec_from_file_location("revision_report", REPOSITORY / "benchmarks" / "revision" / "report.py")
report = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(report)

HERE = {
    "evaluate": [
        {"parts": {"strut": {"peak": 0.1 + 0.2, "fem_seconds": 1.0, "work": 2.0}}, "provenance": {"commit": "a"}},
    ]
}


def test_last_bits_count_and_times_do_not(capsys):
    there = json.loads(json.dumps(HERE))
    strut = there["evaluate"][0]["parts"]["strut"]
    strut["fem_seconds"] = 7.0
    there["evaluate"][0]["provenance"]["commit"] = "b"
    assert report.print_differences(HERE, there) == 0
    strut["peak"] = 0.3
    assert report.print_differences(HERE, there) == 1
    printed = capsys.readouterr().out
    assert "evaluate.0.parts.strut.peak: 0.30000000000000004 here, 0.3 in the revision" in printed
    assert "1 of 2 values differ" in printed


def test_numbers_that_only_one_side_has_are_told_apart(capsys):
    there = json.loads(json.dumps(HERE))
    del there["evaluate"][0]["parts"]["strut"]["work"]
    assert report.print_differences(HERE, there) == 0
    assert "only here: evaluate[].parts.strut.work (1 times)" in capsys.readouterr().out


def test_times_are_compared_by_their_medians(capsys):
    times = {"here": (1.0, 9.0, 1.2), "revision": (2.0, 2.0, 2.1), "again": (2.2, 2.2, 0.1)}
    report.print_times([f'{n} {{"flight": {v[k]}}}' for k in range(3) for n, v in times.items()])
    assert "| flight | 1.200 | 2.000 | 0.600 | 1.100 |" in capsys.readouterr().out
