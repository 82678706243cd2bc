"""Unknown names: what a message suggests instead."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

MOST_LISTED = 20  # names in a message


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
