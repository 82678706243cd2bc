"""The folder of an export: written whole or not at all, never over the files of another design."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path, PurePosixPath
from typing import Any

from codesign.errors import ExportError
from codesign.files import temporary_folder

MANIFEST = "manifest.json"


@contextmanager
def export_folder(out: Path, revision: str, force: bool = False) -> Iterator[Path]:
    """A folder to write an export into; what is in it at the end replaces an earlier export in `out`.

    revision: of the exported design, as in the manifest; an export of the same revision is replaced without asking.
    force: also replace that of another one, and write beside files that are no export.

    Raises: ExportError if `out` holds something else, or cannot be written.
    """
    _check(out, revision, force)
    try:
        out.parent.mkdir(parents=True, exist_ok=True)
        with temporary_folder(out) as work:
            yield work
            for file in _listed(_manifest(out)):
                (out / file).unlink(missing_ok=True)
            # The manifest is the last to come: a folder that has it is complete.
            for source in sorted(files_in(work), key=lambda path: path.name == MANIFEST):
                target = out / source.relative_to(work)
                target.parent.mkdir(parents=True, exist_ok=True)
                source.replace(target)
    except OSError as error:
        raise ExportError(f"{out}: the export cannot be written: {error.strerror or error}") from error


def files_in(folder: Path) -> list[Path]:
    """All files in and below a folder, sorted."""
    return sorted(path for path in folder.rglob("*") if path.is_file())


def _check(out: Path, revision: str, force: bool) -> None:
    if out.exists() and not out.is_dir():
        raise ExportError(f"{out} is a file: name a folder")
    if force or not out.is_dir() or not any(out.iterdir()):
        return
    manifest = _manifest(out)
    if manifest is None:
        raise ExportError(f"{out} is not empty and holds no export: name another folder, or add --force")
    if manifest.get("revision") != revision:
        raise ExportError(
            f"{out} holds {_words(manifest)}, not this design: name another folder, or add --force to replace it"
        )


def _manifest(out: Path) -> dict[str, Any] | None:
    """Manifest of the export in a folder; None if there is none that can be read."""
    try:
        document = json.loads((out / MANIFEST).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return document if isinstance(document, dict) and "revision" in document else None


def _words(manifest: dict[str, Any]) -> str:
    """What an export is of, in words."""
    try:
        design = ", ".join(f"{name} = {item['value']:g}" for name, item in manifest["design"].items())
        return f"revision {manifest['revision']} of study {manifest['study']['name']} ({design})"
    except (KeyError, TypeError, ValueError, AttributeError):
        return f"revision {manifest['revision']}"


def _listed(manifest: dict[str, Any] | None) -> list[str]:
    """Files of an earlier export, none of them outside its folder."""
    files = (manifest or {}).get("files", [])
    names = [file for file in files if isinstance(file, str)] if isinstance(files, list) else []
    paths = {name: PurePosixPath(name) for name in names}
    return [name for name, path in paths.items() if not path.is_absolute() and ".." not in path.parts]
