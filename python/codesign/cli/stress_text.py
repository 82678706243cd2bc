"""What `codesign stress` found, as text on a terminal."""

from __future__ import annotations

from typing import Any

from rich.table import Table
from rich.text import Text

from codesign.cli.console import out
from codesign.cli.stress_file import describe_repair


def print_stress(document: dict[str, Any]) -> None:
    """Text summary of `codesign stress`."""
    table = Table(show_header=False, box=None, pad_edge=False)
    factor = document["safety_factor"]
    known = document["safety_factor_reason"] if factor is None else f"{factor:.3g}"
    table.add_row("safety factor", f"{known} ({document['material']})")
    peak = f"{document['peak_stress'] / 1e6:.4g} ± {document['stress_error'] / 1e6:.2g} MPa"
    unresolved = "" if document["peak_resolved"] else " (not resolved)"
    table.add_row("peak stress", f"{peak}{unresolved} at {_millimeters(document['peak_position'])}")
    table.add_row("largest stress left out", _describe_left_out(document["left_out"]))
    table.add_row("stress exceeded in 50 mm³", f"{document['stress_50'] / 1e6:.4g} MPa")
    table.add_row("largest displacement", f"{document['max_displacement'] * 1e3:.4g} mm")
    for place in document["places"]:
        table.add_row(f"{place['kind']} {place['selection']}", _describe_place(place))
    if document["repair"] is not None:
        table.add_row("repair", describe_repair(document["repair"]))
    if document["smoothing"] is not None:
        table.add_row("facets curved back", _describe_facets(document["smoothing"]))
    if document["facets_literal"] is not None:
        table.add_row("facets that look round", _describe_facets(document["facets_literal"]) + " if --smooth")
    table.add_row("elements", _describe_elements(document))
    table.add_row("seconds", "  ".join(f"{key} {value:.2f}" for key, value in document["seconds"].items()))
    out.print(table)
    for warning in document["warnings"]:
        out.print(Text.assemble(("warning", "yellow"), f": {warning}"))


def _millimeters(position: list[float]) -> str:
    return ", ".join(f"{1e3 * x:.2f}" for x in position) + " mm"


def _describe_left_out(left_out: dict[str, Any] | None) -> str:
    if left_out is None:
        return "none"
    border = f"{left_out['border_distance'] * 1e3:.2g} mm from a border of a clamp or load"
    return f"{left_out['stress'] / 1e6:.4g} MPa at {_millimeters(left_out['position'])}, {border}"


def _describe_place(place: dict[str, Any]) -> str:
    bend = f", bends by {place['bend_deg']:.0f}°" if place["bend_deg"] >= 0.5 else ""
    facets = f", {place['facets']} facets" if place["facets"] else ", part of a facet"
    return f"{place['type']}, {place['area'] * 1e6:.4g} mm² at {_millimeters(place['centroid'])}{bend}{facets}"


def _describe_elements(document: dict[str, Any]) -> str:
    size, smallest = 1e3 * document["edge_length"], 1e3 * document["smallest_edge_length"]
    thin = f", {smallest:.3g} mm at thin walls" if smallest < size else ""
    rounds = document["mesh"]["refinements"]
    refined = f", refined {rounds}x to keep the surface whole" if rounds else ""
    return f"{document['tetrahedra']}, edge length {size:.3g} mm{thin}{refined}"


def _describe_facets(facets: dict[str, Any]) -> str:
    if facets["reason"]:
        return f"none: {facets['reason']}"
    left = f", {facets['left']} left flat to avoid folding" if facets["left"] else ""
    distance, volume = f"{1e3 * facets['max_distance']:.2g} mm", f"{facets['volume_change']:+.2%}"
    return f"{facets['facets']} by up to {distance}, volume {volume}{left}"
