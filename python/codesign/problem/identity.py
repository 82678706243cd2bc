"""What decides the results of a study, by name, so that results of different programs never mix."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any


@dataclass(frozen=True, slots=True)
class Identity:
    """Everything that decides a result.

    sources: what was read (the study's settings, the robot, the parts' modules, the engine) -> hash of its content.
    libraries: every library whose result enters a result -> version in use.
    """

    sources: Mapping[str, str] = field(default_factory=dict)
    libraries: Mapping[str, str] = field(default_factory=dict)

    @property
    def hash(self) -> str:
        """16 hexadecimal digits; equal for equal identities only."""
        return hashlib.sha256(json.dumps(asdict(self), sort_keys=True).encode()).hexdigest()[:16]

    @property
    def program(self) -> Identity:
        """The part that does not depend on a study: the engine and the libraries."""
        return Identity({name: value for name, value in self.sources.items() if name == "engine"}, self.libraries)

    def document(self) -> dict[str, Any]:
        """As stored: JSON values only."""
        return {"sources": dict(self.sources), "libraries": dict(self.libraries)}

    @classmethod
    def from_document(cls, document: Mapping[str, Any] | None) -> Identity:
        """Inverse of `document`; empty if there is none (stored before identities were)."""
        return cls(**document) if document else cls()

    def differences(self, now: Identity) -> str:
        """What is different `now`, for people: 'manifold3d was 3.0.0, is 3.5.4; the robot has changed'."""
        if not self.sources and not self.libraries:
            return "what has changed is not known: nothing but a hash was stored"
        changed = [f"the {name} has changed" for name in _unequal(self.sources, now.sources)]
        changed += version_differences(self.libraries, now.libraries)
        return "; ".join(changed) or "no difference"


def version_differences(then: Mapping[str, str], now: Mapping[str, str]) -> list[str]:
    """A phrase for every library of another version: 'manifold3d was 3.0.0, is 3.5.4'."""
    return [f"{name} was {then.get(name, 'absent')}, is {now.get(name, 'absent')}" for name in _unequal(then, now)]


def _unequal(then: Mapping[str, str], now: Mapping[str, str]) -> list[str]:
    return [name for name in dict.fromkeys([*then, *now]) if then.get(name) != now.get(name)]
