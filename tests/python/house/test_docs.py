"""The tutorial does what it says: its files and commands are run as they stand."""

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from codesign.storage.runs import load_run

DOCS = Path(__file__).resolve().parents[3] / "docs"
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\]\(([^)#:\s]+)(#[^)]*)?\)")


def blocks(page):
    return BLOCK.findall((DOCS / page).read_text())


@pytest.fixture(scope="module")
def tutorial(tmp_path_factory):
    """The folder of someone who has followed the tutorial."""
    folder = tmp_path_factory.mktemp("tutorial")
    for language, text in blocks("tutorial.md"):
        if language in ("python", "toml"):
            name = text.partition("\n")[0].removeprefix("# ")
            (folder / name).parent.mkdir(exist_ok=True)
            (folder / name).write_text(text)
        elif language == "sh":
            for line in text.splitlines():
                program, *arguments = shlex.split(line)
                assert program == "codesign"
                done = subprocess.run(
                    [sys.executable, "-m", "codesign.cli", *arguments],
                    cwd=folder, capture_output=True, text=True, check=False,
                )  # fmt: skip
                assert done.returncode == 0, (line, done.stdout, done.stderr)
    return folder


def test_the_tutorial_ends_with_a_part_that_can_be_ordered(tutorial):
    run = load_run(tutorial / "runs" / "shelf")
    assert len(run.search_records) == 12
    assert repr(run).endswith(f"of shelf: 12 designs, {len(run.front)} on the front>")
    names = {path.suffix for path in (tutorial / "order").rglob("*")}
    assert {".stl", ".step", ".json", ".csv", ".vtu"} <= names


def test_code_of_the_page_on_runs_reads_that_run(tutorial, monkeypatch, capsys):
    monkeypatch.chdir(tutorial)
    for language, text in blocks("howto/read_run.md"):
        if language == "python":
            exec(compile(text, "read_run.md", "exec"), {})
    assert capsys.readouterr().out.startswith("<Run 'runs/shelf' of shelf: 12 designs")


@pytest.mark.parametrize("page", sorted(str(path.relative_to(DOCS)) for path in DOCS.rglob("*.md")))
def test_links_to_pages_lead_somewhere(page):
    for target, _ in LINK.findall((DOCS / page).read_text()):
        assert target.startswith("api/cli") or (DOCS / page).parent.joinpath(target).exists(), target


def test_every_page_is_in_the_table_of_contents():
    """What `make docs` refuses otherwise; api/cli is written by it."""
    lists = re.findall(r"^```\{toctree\}\n(.*?)^```$", (DOCS / "index.md").read_text(), re.MULTILINE | re.DOTALL)
    entries = [line for text in lists for line in text.splitlines() if line and not line.startswith(":")]
    named = {page for entry in entries for page in DOCS.glob(f"{entry}.md")}
    pages = {page for page in DOCS.rglob("*.md") if page != DOCS / "index.md"}
    assert {str(page.relative_to(DOCS)) for page in pages - named} == set()


def test_pages_link_to_pages_only():
    """Nothing beside docs/, which the site does not have."""
    outside = {
        (page.name, target)
        for page in DOCS.rglob("*.md")
        for target, _ in LINK.findall(page.read_text())
        if not (page.parent / target).resolve().is_relative_to(DOCS)
    }
    assert outside == set()


@pytest.mark.parametrize("page", sorted(str(path.relative_to(DOCS)) for path in DOCS.rglob("*.md")))
def test_pages_speak_of_codesign_not_of_us(page):
    lines = (DOCS / page).read_text().splitlines()
    assert [line for line in lines if re.search(r"\b([Oo]urs?|[Ww]e)\b", line)] == []
