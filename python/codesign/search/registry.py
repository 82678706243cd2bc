"""Searches by name: built in, from other packages (entry points `codesign.searches`), or `module:attribute`."""

from __future__ import annotations

import dataclasses
import difflib
import importlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from importlib.metadata import entry_points
from typing import TYPE_CHECKING, Any

from codesign.problem.design_space import DesignSpace
from codesign.search.base import Search

if TYPE_CHECKING:
    from codesign.search.settings import Settings

ENTRY_POINTS = "codesign.searches"
BUILT_IN = {
    "nsga2": "codesign.search.pymoo_search:NSGA2",
    "nsga3": "codesign.search.pymoo_search:NSGA3",
    "agemoea": "codesign.search.pymoo_search:AGEMOEA",
    "agemoea2": "codesign.search.pymoo_search:AGEMOEA2",
    "smsemoa": "codesign.search.pymoo_search:SMSEMOA",
    "surrogate": "codesign.search.surrogate_search:SURROGATE",
    "random": "codesign.search.sampling:RANDOM",
    "listed": "codesign.search.sampling:LISTED",
}


@dataclass(frozen=True)
class NoOptions:
    """Of a search that has none."""


@dataclass(frozen=True, slots=True)
class SearchKind:
    """What a search is to the driver.

    make: builds it for a design space and the keys of the minimized numbers. learns: what it asks for depends on what
    it was told, so it is asked for one generation at a time. options: a dataclass of its own settings, all with
    defaults. batch: of these options, how many designs are asked for at a time after the start population, while as
    many are still being evaluated; None: a generation. evaluations: the budget where none is given; None: that of the
    study's generations. lazy: whether strength and clearances of designs that cannot enter the front are left out where
    the study does not say.
    """

    make: Callable[[DesignSpace, Sequence[str], Settings, Any], Search]
    learns: bool = True
    options: type = NoOptions
    batch: Callable[[Any], int] | None = None
    evaluations: int | None = None
    lazy: bool = False

    def checked_options(self, given: Mapping[str, Any]) -> Any:
        """The options as an object. Raises: ValueError for an unknown name."""
        known = [field.name for field in dataclasses.fields(self.options)]
        for name in given:
            if name not in known:
                raise ValueError(f"option {name!r}: this search has {', '.join(known) or 'no options'}")
        return self.options(**given)


def search_address(name: str) -> str:
    """`module:attribute` of the search of a name. Raises: ValueError: there is none."""
    others = {point.name: point.value for point in entry_points(group=ENTRY_POINTS)} if name not in BUILT_IN else {}
    address = BUILT_IN.get(name) or others.get(name) or name
    if ":" not in address:
        known = [*BUILT_IN, *others]
        near = difflib.get_close_matches(name, known, n=1)
        hint = f"did you mean {near[0]!r}?" if near else f"there are {', '.join(known)}; or module:attribute"
        raise ValueError(f"algorithm = {name!r}: no such search; {hint}")
    return address


def find_search(name: str) -> SearchKind:
    """The search of a name. Raises: ValueError: there is none, or it cannot be imported."""
    address = search_address(name)
    module, _, attribute = address.partition(":")
    try:
        kind = getattr(importlib.import_module(module), attribute)
    except (ImportError, AttributeError) as error:
        raise ValueError(f"algorithm = {name!r}: {error}") from error
    if not isinstance(kind, SearchKind):
        raise ValueError(f"algorithm = {name!r}: {address} is not a codesign.search.registry.SearchKind")
    return kind
