"""Files written whole or not at all: beside the target first, then renamed."""

from __future__ import annotations

import errno
import os
import tempfile
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from codesign.errors import FileError
from codesign.interrupts import temporary


@contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """A temporary path beside `path`, with its suffix; renamed to it at the end, or removed if the block fails.

    Raises: FileNotFoundError if there is no such folder; FileError if `path` is a folder or a device.
    """
    path = Path(path)
    _refuse_other_kinds(path)
    if not path.parent.is_dir():
        raise FileNotFoundError(errno.ENOENT, f"there is no folder {path.parent}", str(path))
    name = f".{path.stem}.{threading.get_native_id()}.tmp{path.suffix}"  # no two threads share it
    with temporary(path.with_name(name)) as beside:
        beside.unlink(missing_ok=True)  # of a writer that was killed
        try:
            yield beside
            beside.replace(path)
        finally:
            beside.unlink(missing_ok=True)


@contextmanager
def temporary_folder(path: Path) -> Iterator[Path]:
    """A new folder beside `path`, removed with all that is in it at the end."""
    with (
        tempfile.TemporaryDirectory(prefix=f".{path.name}.", dir=path.parent) as name,
        temporary(Path(name)) as folder,
    ):
        yield folder


def check_target(path: str | os.PathLike[str]) -> None:
    """Makes the folder of a file to be written and tries it, before work is done whose result would be lost.

    Raises: FileError.
    """
    path = Path(path)
    _refuse_other_kinds(path)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=path.parent):
            pass
    except OSError as error:
        raise FileError(f"{path}: cannot be written: {error.strerror or error}") from None


def _refuse_other_kinds(path: Path) -> None:
    """A folder or a device would be replaced by the file."""
    if path.is_dir():
        raise FileError(f"{path}: is a folder; name a file in it")
    if path.exists() and not path.is_file():
        raise FileError(f"{path}: is no regular file, cannot be replaced")


def write_text(path: str | Path, text: str) -> Path:
    """Writes UTF-8 text as `write_bytes` does; returns the path."""
    return write_bytes(path, text.encode())


def write_bytes(path: str | Path, content: bytes) -> Path:
    """Writes bytes; a reader never sees a half-written file, and a failure leaves the old one. Returns the path."""
    with replacing(path) as beside:
        beside.write_bytes(content)
    return Path(path)
