"""Files that a mesh file refers to: materials of OBJ, textures, buffers of glTF; without them it loses its colors."""

from __future__ import annotations

import json
import os
import re
import struct
from collections.abc import Sequence
from pathlib import Path
from typing import Any
from urllib.parse import unquote

from codesign.errors import UrdfError

_TEXTURES = re.compile(r"^\s*(?:map_\w+|bump|disp|decal|refl|norm)\s+(.+?)\s*$", re.MULTILINE | re.IGNORECASE)
_LIBRARIES = re.compile(r"^\s*mtllib\s+(.+?)\s*$", re.MULTILINE)
_IMAGES = re.compile(r"<init_from>\s*(?:<ref>)?\s*([^<>]+?)\s*(?:</ref>)?\s*</init_from>")
_GLB_HEADER = 20  # bytes before the JSON chunk


def companions(mesh: Path, allowed: Sequence[Path]) -> list[Path]:
    """Existing files that a mesh file needs beside it, also by way of others; what is not there is left out.

    allowed: folders in which they must lie, links followed. Raises: UrdfError naming a file outside of them.
    """
    found: list[Path] = []
    pending = [mesh]
    while pending:
        owner = pending.pop()
        for reference in _references(owner):
            path = Path(os.path.normpath(owner.parent / reference))
            if not path.is_file() or path in found or path == mesh:
                continue
            if not any(path.resolve().is_relative_to(root.resolve()) for root in allowed):
                raise UrdfError(f"{owner}: {reference!r} leaves the folders it may be read from")
            found.append(path)
            pending.append(path)
    return found


def _references(path: Path) -> list[str]:
    """References to other files, relative to the folder of the file that has them."""
    kind = path.suffix.lower()
    if kind == ".obj":
        lines = _LIBRARIES.findall(_text(path))
        return [name for line in lines for name in dict.fromkeys((line, *line.split()))]
    if kind == ".mtl":
        return [_texture(line) for line in _TEXTURES.findall(_text(path))]
    if kind == ".dae":
        return [unquote(name).removeprefix("file://") for name in _IMAGES.findall(_text(path))]
    if kind in (".gltf", ".glb"):
        document = _gltf(path)
        items = [item for key in ("buffers", "images") for item in document.get(key, [])]
        uris = [item["uri"] for item in items if isinstance(item, dict) and isinstance(item.get("uri"), str)]
        return [unquote(uri) for uri in uris if not uri.startswith("data:")]
    return []


def _texture(line: str) -> str:
    """The file behind the options of a texture, which begin with a minus."""
    words = line.split()
    return words[-1] if words[0].startswith("-") else line


def _text(path: Path) -> str:
    return path.read_bytes().decode("utf-8", "replace")


def _gltf(path: Path) -> dict[str, Any]:
    """The JSON document of a glTF file; empty if there is none."""
    content = path.read_bytes()
    if content[:4] == b"glTF" and len(content) >= _GLB_HEADER:
        (length,) = struct.unpack_from("<I", content, 12)
        content = content[_GLB_HEADER : _GLB_HEADER + length]
    try:
        document = json.loads(content)
    except ValueError:
        return {}
    return document if isinstance(document, dict) else {}
