"""General tolerances (ISO 2768-1 class m, ISO 2768-2 class K) and fits of bores (ISO 286, H), in mm."""

from __future__ import annotations

from codesign.errors import GeometryError

GENERAL = "ISO 2768-mK"
# Largest nominal size of a row, and its value.
_LENGTHS_M = ((3.0, 0.1), (6.0, 0.1), (30.0, 0.2), (120.0, 0.3), (400.0, 0.5), (1000.0, 0.8), (2000.0, 1.2))
_FLATNESS_K = ((10.0, 0.05), (30.0, 0.1), (100.0, 0.2), (300.0, 0.4), (1000.0, 0.6), (3000.0, 0.8))
_GRADES = (6, 7, 8, 9)
_STANDARD_TOLERANCES = (  # ISO 286-1: IT6 … IT9 in micrometers
    (3.0, (6, 10, 14, 25)),
    (6.0, (8, 12, 18, 30)),
    (10.0, (9, 15, 22, 36)),
    (18.0, (11, 18, 27, 43)),
    (30.0, (13, 21, 33, 52)),
    (50.0, (16, 25, 39, 62)),
    (80.0, (19, 30, 46, 74)),
    (120.0, (22, 35, 54, 87)),
    (180.0, (25, 40, 63, 100)),
)


def general_length(size: float) -> float:
    """Permissible deviation, plus and minus, of a length or diameter: ISO 2768-1, class m."""
    return _row(_LENGTHS_M, size)


def general_flatness(length: float) -> float:
    """Flatness of a face of that length: ISO 2768-2, class K."""
    return _row(_FLATNESS_K, length)


def bore_fit(diameter: float, fit: str) -> tuple[float, float]:
    """Lower and upper deviation of a bore, as `H7`: the basic hole of ISO 286.

    Raises: GeometryError for another letter, a grade outside 6 to 9, or a diameter above 180 mm.
    """
    letter, grade = fit[:1], fit[1:]
    if letter != "H" or not grade.isdigit() or int(grade) not in _GRADES or diameter > _STANDARD_TOLERANCES[-1][0]:
        raise GeometryError(f"fit {fit!r} of a bore of {diameter:g} mm: only H6 to H9 up to 180 mm are known")
    micrometers = next(values for limit, values in _STANDARD_TOLERANCES if diameter <= limit)
    return 0.0, 1e-3 * micrometers[_GRADES.index(int(grade))]


def _row(table: tuple[tuple[float, float], ...], size: float) -> float:
    return next((value for limit, value in table if size <= limit), table[-1][1])
