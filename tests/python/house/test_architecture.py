"""docs/architecture.md and CONTRIBUTING.md say what the code is: wings, arrows, and places where changes are made."""

import importlib.util
import re
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[3]
SPEC = importlib.util.spec_from_file_location("picture", REPOSITORY / "scripts" / "architecture_picture.py")
picture = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(picture)


def test_the_picture_is_that_of_the_code():
    assert list(picture.faults()) == []
    assert picture.PICTURE.read_text() == picture.picture(), "python scripts/architecture_picture.py"


def test_what_differs_is_named(monkeypatch):
    graph = {**picture.python_graph(), "workshop": {"fem"}}
    graph["geometry"] = graph["geometry"] | {"parts"}
    monkeypatch.setattr(picture, "python_graph", lambda: graph)
    assert "PLACES of this script: no workshop, which the code has" in list(picture.faults())
    with pytest.raises(SystemExit, match="a circle"):
        picture.arrows()


def test_arrows_follow_from_imports_and_leave_out_what_others_imply():
    arrows = set(picture.arrows())
    assert {("chain", "study"), ("fem", "geometry"), ("cpp/fem/la", "cpp/fem/boundary")} <= arrows
    assert "fem" in picture.python_graph()["chain"]
    assert ("chain", "fem") not in arrows


def test_boxes_do_not_overlap_and_arrows_cross_none():
    corners = {}
    for box, (x, y) in picture.PLACES.items():
        w, h = picture.half_width(box), picture.HALF_HEIGHT
        corners[box] = (x - w, x + w, y - h, y + h)
    for box, (left, right, top, bottom) in corners.items():
        others = (other for name, other in corners.items() if name != box)
        assert all(right < o[0] or o[1] < left or bottom < o[2] or o[3] < top for o in others), box
    for upper, lower in picture.arrows():
        (x1, y1), (x2, y2) = picture.ends(upper, lower)
        for box, (left, right, top, bottom) in corners.items():
            inside = (
                (x1 + (x2 - x1) * k / 200, y1 + (y2 - y1) * k / 200) for k in range(201) if box not in (upper, lower)
            )
            assert not any(left < x < right and top < y < bottom for x, y in inside), (upper, lower, box)


@pytest.mark.parametrize("page", ["CONTRIBUTING.md", "docs/architecture.md"])
def test_files_that_are_named_exist(page):
    text = (REPOSITORY / page).read_text()
    named = re.findall(r"`((?:[\w.]+/)+[\w.]+)(?:::\w+)?`", text)
    assert len(named) > 10
    roots = (REPOSITORY, REPOSITORY / "python" / "codesign")
    assert [n for n in named if not any((r / n).exists() or list(r.glob(f"{n}.*")) for r in roots)] == []


@pytest.mark.parametrize(
    ("name", "file"),
    [
        ("_TABLE", "python/codesign/problem/quantities.py"),
        ("FLIGHT_NUMBERS", "python/codesign/chain/documents.py"),
        ("BUILT_IN", "python/codesign/search/registry.py"),
        ("kMembers", "cpp/fem/boundary/loads.hpp"),
        ("LoadAdder", "cpp/fem/boundary/loads.cpp"),
        ("LOAD_KINDS", "python/codesign/study/load_config.py"),
        ("FAMILY", "python/codesign/problem/quantities.py"),
    ],
)
def test_tables_that_a_change_is_an_entry_of(name, file):
    text = (REPOSITORY / "CONTRIBUTING.md").read_text()
    assert f"`{name}`" in text
    assert file.removeprefix("python/codesign/") in text
    assert re.search(rf"\b{name}\b", (REPOSITORY / file).read_text())
