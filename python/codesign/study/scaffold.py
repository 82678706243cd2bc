"""Start of a new study: a commented, runnable copy of a shipped one."""

from __future__ import annotations

import json
import re
import shutil
import tomllib
from collections.abc import Mapping
from pathlib import Path

from codesign.errors import StudyError
from codesign.names import nearest
from codesign.study.loading import EXTENDS, STUDIES, shipped_studies
from codesign.study.reference import SCHEMA_FILE, study_schema

SHIPPED_MODULE = re.compile(r'"codesign\.studies\.(\w+)\.(\w+):')  # of a part or a function, in a study's text


def new_study(folder: str | Path, template: str = "gimbal_quad") -> list[Path]:
    """Writes a commented, runnable copy of a shipped study into a new folder and returns the files.

    Of a study that extends others, these lie beside it, `NAME.toml` each; robot and modules of all of them are in the
    folder too, so that nothing refers to the package any more.

    Raises: StudyError if the folder holds files already, or there is no such study.
    """
    folder = Path(folder)
    if template not in shipped_studies():
        raise StudyError(f"no shipped study {template!r}; {nearest(template, shipped_studies())}")
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise StudyError(f"{folder}: exists and is not empty")
    folder.mkdir(parents=True, exist_ok=True)
    texts = _chain(template)
    copied = []
    for place, (name, text) in enumerate(texts.items()):
        file = folder / ("study.toml" if place == 0 else f"{name}.toml")
        file.write_text(_beside(text, texts), encoding="utf-8")
        copied.append(file)
    for source in _other_files(texts):
        copied.append(Path(shutil.copy(source, folder / source.name)))
    schema = folder / SCHEMA_FILE
    schema.write_text(json.dumps(study_schema(), indent=1) + "\n", encoding="utf-8")
    return [*sorted(copied), schema]


def _chain(template: str) -> dict[str, str]:
    """The text of a shipped study and of all that it builds on, by name."""
    texts: dict[str, str] = {}
    name = template
    while name:
        texts[name] = (STUDIES / name / "study.toml").read_text(encoding="utf-8")
        name = tomllib.loads(texts[name]).get(EXTENDS, "")
    return texts


def _beside(text: str, names: Mapping[str, str]) -> str:
    """The text of a study whose base, robot and modules lie in the same folder."""
    text = SHIPPED_MODULE.sub(r'"\2:', text)
    text = re.sub(r'^urdf = "[^"]*?([^"/]+)"', r'urdf = "\1"', text, flags=re.MULTILINE)
    bases = "|".join(names)
    return re.sub(rf'^{EXTENDS} = "({bases})"', rf'{EXTENDS} = "\1.toml"', text, flags=re.MULTILINE)


def _other_files(texts: Mapping[str, str]) -> list[Path]:
    """Robot, modules and what else lies in the folders of shipped studies, or is named by them."""
    files = []
    for name, text in texts.items():
        folder = STUDIES / name
        files += [file for file in sorted(folder.iterdir()) if file.is_file()]
        files += [STUDIES / study / f"{module}.py" for study, module in SHIPPED_MODULE.findall(text)]
        if robot := tomllib.loads(text).get("robot", {}).get("urdf"):
            urdf = (folder / robot).resolve()
            files += [file for file in (urdf, urdf.with_suffix(".toml")) if file.is_file()]
    chosen = {file.name: file for file in files if file.name not in ("__init__.py", "study.toml")}
    return list(chosen.values())
