"""Names: what a message suggests instead of an unknown one; what other programs take as one."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable

MOST_LISTED = 20  # names in a message


def identifier(name: str) -> str:
    """The name with letters, digits and underscores only, as programs and USD want it."""
    plain = re.sub(r"[^0-9A-Za-z_]", "_", name)
    return plain if re.match(r"[A-Za-z_]", plain) else f"_{plain}"


def closest(name: str, known: Iterable[str]) -> str | None:
    """The known name most like `name`; None if none is like it."""
    found = difflib.get_close_matches(name, list(known), n=1)
    return found[0] if found else None


def nearest(name: str, known: Iterable[str]) -> str:
    """What to try instead of an unknown name, for a message: the closest known one, else all of them."""
    known = list(known)
    found = closest(name, known)
    if found is not None:
        return f"did you mean {found!r}?"
    if not known:
        return "there are none"
    rest = f" and {len(known) - MOST_LISTED} more" if len(known) > MOST_LISTED else ""
    return f"there are {', '.join(name or repr(name) for name in known[:MOST_LISTED])}{rest}"
