"""Where a number comes from: version, commit, study."""

from __future__ import annotations

import functools
import platform
import subprocess
from pathlib import Path
from typing import Any

import codesign
from codesign.study import StudyData


@functools.cache
def source_commit() -> str | None:
    """Commit of the source tree this package runs from (with `+` if files are changed); None outside of a checkout."""
    folder = Path(__file__).parent

    def git(*arguments: str) -> str:
        command = ("git", "-C", str(folder), *arguments)
        return subprocess.run(command, capture_output=True, text=True, check=True, timeout=10).stdout.strip()

    try:
        git("ls-files", "--error-unmatch", Path(__file__).name)
        return git("rev-parse", "--short=12", "HEAD") + ("+" if git("status", "--porcelain", "-uno") else "")
    except (OSError, subprocess.SubprocessError):
        return None


def provenance(study: StudyData) -> dict[str, Any]:
    """What is stored with every evaluation."""
    return {
        "version": codesign.__version__,
        "study_hash": study.hash,
        "libraries": dict(study.identity.libraries),
        "commit": source_commit(),
        "machine": platform.node(),
    }
