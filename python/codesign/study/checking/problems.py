"""What a check yields, and checks of names that all sections share."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator

from codesign.names import nearest

Problem = tuple[str, str]  # key, reason


def repeated(names: Iterable[str]) -> str | None:
    """The first name that occurs twice."""
    return next((name for name, count in Counter(names).items() if count > 1), None)


def unknown(key: str, kind: str, name: str, known: Iterable[str]) -> Iterator[Problem]:
    """The problem that a name is not among the known ones."""
    known = list(known)
    if name not in known:
        yield key, f"no {kind} {name!r}; {nearest(name, known)}"
