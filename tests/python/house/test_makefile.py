"""The set-up notices that a checkout has moved, since virtual environment and build tree hold its path."""

import shutil
import subprocess
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[3]


@pytest.mark.parametrize(
    ("made_in", "goal", "kept"),
    [("elsewhere", "moved", False), ("elsewhere", "help", True), ("here", "moved", True), (None, "moved", True)],
)
def test_a_moved_checkout_is_set_up_again(tmp_path, made_in, goal, kept):
    shutil.copy(REPOSITORY / "Makefile", tmp_path)
    with (tmp_path / "Makefile").open("a") as makefile:
        makefile.write("\nmoved:\n\t@true\n")
    for folder in (".venv", "build", "cpp", "cmake"):
        (tmp_path / folder).mkdir()
    if made_in:
        (tmp_path / ".venv" / "folder").write_text(f"{tmp_path if made_in == 'here' else '/elsewhere'}\n")
    done = subprocess.run(["make", goal], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert ("were made in /elsewhere: setting up again" in done.stdout) is not kept
    assert (tmp_path / ".venv").is_dir() is kept
    assert (tmp_path / "build").is_dir() is kept
