"""Start of a new study: a commented, runnable copy of a shipped one."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

from codesign.errors import StudyError
from codesign.study.loading import STUDIES
from codesign.study.reference import SCHEMA_FILE, study_schema


def new_study(folder: str | Path, template: str = "gimbal_quad") -> list[Path]:
    """Writes a commented, runnable study into a new folder and returns the files.

    Raises: StudyError if the folder holds files already.
    """
    folder = Path(folder)
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise StudyError(f"{folder}: exists and is not empty")
    folder.mkdir(parents=True, exist_ok=True)
    sources = sorted(p for p in (STUDIES / template).iterdir() if p.is_file() and p.name != "__init__.py")
    copied = [Path(shutil.copy(source, folder / source.name)) for source in sources]
    schema = folder / SCHEMA_FILE
    schema.write_text(json.dumps(study_schema(), indent=1) + "\n", encoding="utf-8")
    return [*copied, schema]
