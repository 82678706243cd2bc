"""Formatters, linters and the type checker run as tests, so that `make test` is the whole gate."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[3]


def run(*command: str) -> None:
    result = subprocess.run(command, cwd=REPOSITORY, capture_output=True, text=True, check=False)
    assert result.returncode == 0, f"{' '.join(command[:4])} …\n{result.stdout}{result.stderr}"


def tool(name: str) -> str:
    beside = Path(sys.executable).with_name(name)
    found = str(beside) if beside.exists() else shutil.which(name)
    if found is None:
        pytest.fail(f"{name} is missing: install the extra 'test'")
    return found


def test_python_is_formatted():
    run(tool("ruff"), "format", "--check", ".")


def test_python_lints():
    run(tool("ruff"), "check", ".")


def test_python_types():
    run(tool("mypy"))


def test_cpp_is_formatted():
    sources = [str(p) for folder in ("cpp", "tests/cpp") for p in sorted((REPOSITORY / folder).rglob("*.[ch]pp"))]
    run(tool("clang-format"), "--dry-run", "--Werror", *sources)
