"""docs/figures/architecture.svg: the wings of the Python package and the rooms of cpp/, drawn from the code.

Usage: architecture_picture.py [--check]

Boxes and their words are the tables of docs/architecture.md; arrows are the imports and includes that the sources make,
but for those that others imply. Only where a box stands is written here. --check: draws nothing, says what differs.
"""

import ast
import re
import sys
import textwrap
from collections import defaultdict
from collections.abc import Iterator, Mapping
from functools import cache
from html import escape
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
PAGE = REPOSITORY / "docs" / "architecture.md"
PICTURE = REPOSITORY / "docs" / "figures" / "architecture.svg"
PACKAGE, NATIVE = REPOSITORY / "python" / "codesign", REPOSITORY / "cpp"
SHARED, BINDINGS, BASE = "shared words", "cpp/bindings", "cpp/base"
# Where each box stands: column and row of its center; arrows point to larger rows.
PLACES = {
    "cli": (1.4, 0), "followup": (0.9, 1), "viewer": (1.9, 1), "report": (1.4, 2), "search": (0.2, 3),
    "chain": (2.3, 3), "execution": (-0.2, 4), "study": (2.3, 4), "storage": (0.0, 5), "studies": (3.55, 5),
    "surrogate": (0.95, 6), "robot": (2.2, 6), "parts": (3.55, 6), "fem": (3.55, 7), "problem": (0.8, 8),
    "geometry": (3.55, 8), SHARED: (1.75, 9), BINDINGS: (1.75, 10.3),
    "cpp/dynamics/urdf": (-0.2, 11.3), "cpp/dynamics/flight": (0.75, 11.3), "cpp/dynamics/predictive": (0.75, 12.3),
    "cpp/dynamics": (0.0, 13.3), "cpp/fem": (2.5, 11.3), "cpp/fem/elasticity": (2.0, 12.3),
    "cpp/fem/stress": (0.95, 13.3), "cpp/fem/la": (2.05, 13.3), "cpp/fem/boundary": (2.0, 14.3),
    "cpp/fem/meshing": (3.0, 14.3), "cpp/fem/smoothing": (3.7, 15.3), "cpp/fem/mesh": (1.8, 16.3),
    "cpp/fem/surface": (1.8, 17.3), BASE: (1.75, 18.3),
}  # fmt: skip
WIDE = {SHARED, BINDINGS, BASE}
COLUMN, ROW = 225.0, 96.0  # distances of centers
LEFT, RIGHT = -0.66, 4.18  # columns
HALF_WIDTH, HALF_HEIGHT, MARGIN = 0.43, 0.36, 0.1  # of a box, and how near to its corner an arrow may be
LETTERS, LINES = 33, 3  # that fit into a box
WIDE_LETTERS = 150
COLORS = {"cpp/dynamics": "#f6e3c5", "cpp/fem": "#dcebd3", "cpp": "#ececec", "": "#d9e6f5"}


def chapter() -> str:
    """The part of the page that has the tables."""
    return PAGE.read_text(encoding="utf-8").partition("\n## Wings\n")[2].partition("\n## ")[0]


def table_words() -> dict[str, str]:
    """Box -> what it knows, from the tables of the page; the row of several names is that of the shared words."""
    rows = re.findall(r"^\| (`[^|]+`) \| ([^|]+) \|$", chapter(), re.MULTILINE)
    words = {}
    for names, knows in rows:
        listed = re.findall(r"`([^`]+)`", names)
        words[listed[0] if len(listed) == 1 else SHARED] = knows.strip()
    return words


def shared_names() -> set[str]:
    """Modules that the page calls shared words."""
    row = re.search(r"^\| ((?:`\w+`, )+`\w+`) \|", chapter(), re.MULTILINE)
    return set(re.findall(r"`(\w+)`", row[1])) if row else set()


@cache
def imported(file: Path) -> set[str]:
    """Parts of the package that a module imports when it runs."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    hints = [n for n in ast.walk(tree) if isinstance(n, ast.If) and "TYPE_CHECKING" in ast.unparse(n.test)]
    unused = {inner for hint in hints for statement in hint.body for inner in ast.walk(statement)}
    names = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Import) and node not in unused:
            names += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node not in unused:
            inside = node.module == "codesign"
            names += [f"codesign.{alias.name}" for alias in node.names] if inside else [node.module or ""]
    return {name.split(".")[1] for name in names if name.startswith("codesign.")}


def python_graph() -> dict[str, set[str]]:
    """Wing -> wings that it imports; what stands in modules at the root is the shared words."""
    graph: dict[str, set[str]] = defaultdict(set)
    wings = {folder.name for folder in PACKAGE.iterdir() if (folder / "__init__.py").is_file()}
    for file in sorted(PACKAGE.rglob("*.py")):
        first = file.relative_to(PACKAGE).parts[0].removesuffix(".py")
        if first != "__init__":
            here = first if first in wings else SHARED
            for name in imported(file):
                there = name if name in wings else BINDINGS if name == "_core" else SHARED
                graph[here] |= {there} - {here}
    return graph


def room(file: str) -> str:
    """Room of a C++ file: of the folder above, if its own has no place; what lies at the root counts as the base."""
    folder = f"cpp/{file}".rpartition("/")[0]
    if folder == "cpp":
        return BASE
    above = folder.rpartition("/")[0]
    return folder if folder in PLACES or above == "cpp" else room(f"{above.removeprefix('cpp/')}/")


def cpp_graph() -> dict[str, set[str]]:
    """Room -> rooms that it includes."""
    graph: dict[str, set[str]] = defaultdict(set)
    for file in sorted(NATIVE.rglob("*.[ch]pp")):
        here = room(file.relative_to(NATIVE).as_posix())
        for included in re.findall(r'^#include "([^"]+)"', file.read_text(encoding="utf-8"), re.MULTILINE):
            graph[here] |= {room(included)} - {here}
    return graph


def below(graph: Mapping[str, set[str]], box: str) -> set[str]:
    """All that a box knows, directly or not. Raises: SystemExit for a circle."""
    found: set[str] = set()
    waiting = set(graph.get(box, ()))
    while waiting:
        found |= waiting
        waiting = {far for near in waiting for far in graph.get(near, ())} - found
    if box in found:
        raise SystemExit(f"{box} knows itself by way of others: a circle")
    return found


def arrows() -> list[tuple[str, str]]:
    """What knows what, but for what others imply."""
    graph = python_graph() | cpp_graph()
    implied = {box: {far for near in known for far in below(graph, near)} for box, known in graph.items()}
    return sorted((box, near) for box, known in graph.items() for near in known - implied[box])


def half_width(box: str) -> float:
    """Half the width of a box, in columns."""
    return (RIGHT - LEFT) / 2 - 0.05 if box in WIDE else HALF_WIDTH


def clamped(x: float, box: str) -> float:
    """The column on a box nearest to one."""
    reach = half_width(box) - MARGIN
    return min(max(x, PLACES[box][0] - reach), PLACES[box][0] + reach)


def point(column: float, row: float) -> tuple[float, float]:
    """Pixels of a place."""
    return round((column - LEFT) * COLUMN, 1), round((row + 0.5) * ROW, 1)


def ends(upper: str, lower: str) -> tuple[tuple[float, float], tuple[float, float]]:
    """Columns and rows of an arrow from the foot of one box to the head of another."""
    (xu, yu), (xl, yl) = PLACES[upper], PLACES[lower]
    start = xl if upper in WIDE else xu if lower in WIDE else clamped(xl, upper)
    return (start, yu + HALF_HEIGHT), (clamped(start if upper in WIDE else xu, lower), yl - HALF_HEIGHT)


def drawn_arrow(upper: str, lower: str) -> str:
    """A line with a head."""
    (x1, y1), (x2, y2) = (point(*end) for end in ends(upper, lower))
    return f'<line x1="{x1}" y1="{y1}" x2="{x2}" y2="{y2 - 3}" marker-end="url(#head)"/>'


def drawn_box(box: str, words: str, title: str) -> str:
    """A rectangle with a name and what it knows."""
    x, y = point(*PLACES[box])
    w, h = 2 * half_width(box) * COLUMN, 2 * HALF_HEIGHT * ROW
    color = next(color for start, color in COLORS.items() if box.startswith(start))
    lines = textwrap.wrap(words.replace("`", ""), WIDE_LETTERS if box in WIDE else LETTERS)
    if len(lines) > LINES:
        raise SystemExit(f"docs/architecture.md: {box}: more than {LINES} lines of {LETTERS} letters: {words}")
    top = y - 7 * len(lines) + 4
    texts = [f'<text class="name" x="{x}" y="{top}">{escape(title)}</text>']
    texts += [f'<text x="{x}" y="{top + 14 * k}">{escape(line)}</text>' for k, line in enumerate(lines, 1)]
    place = f'x="{x - w / 2:.1f}" y="{y - h / 2:.1f}" width="{w:.1f}" height="{h:.1f}"'
    return f'<rect class="box" {place} rx="5" fill="{color}"/>' + "".join(texts)


def picture() -> str:
    """The whole SVG."""
    words = table_words()
    width, height = (RIGHT - LEFT) * COLUMN, (max(row for _, row in PLACES.values()) + 1) * ROW
    title = {SHARED: ", ".join(sorted(shared_names()))}
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}" '
        'font-family="Helvetica, Arial, sans-serif" font-size="11" text-anchor="middle">',
        "<!-- made by scripts/architecture_picture.py -->",
        "<style>.name { font-weight: bold; font-size: 14px } .box { stroke: #444 } line { stroke: #444 }</style>",
        '<defs><marker id="head" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="8" markerHeight="8" orient="auto">'
        '<path d="M0 0L8 4L0 8z" fill="#444"/></marker></defs>',
        f'<rect width="{width:.0f}" height="{height:.0f}" fill="white"/>',
        *(drawn_arrow(*arrow) for arrow in arrows()),
        *(drawn_box(box, words.get(box, ""), title.get(box, box)) for box in PLACES),
        "</svg>",
    ]
    return "\n".join(parts) + "\n"


def faults() -> Iterator[str]:
    """What the picture would say that is not so."""
    graph, words = python_graph() | cpp_graph(), table_words()
    boxes = set(graph) | {near for known in graph.values() for near in known}
    for what, named in (("PLACES of this script", set(PLACES)), ("the tables of docs/architecture.md", set(words))):
        yield from (f"{what}: no {box}, which the code has" for box in sorted(boxes - named))
        yield from (f"{what}: {box}, which the code does not have" for box in sorted(named - boxes))
    modules = {file.stem for file in PACKAGE.glob("*.py")} - {"__init__"} | {"_core"}
    if shared_names() != modules:
        yield f"docs/architecture.md: modules at the root are {', '.join(sorted(modules))}"
    if boxes <= set(PLACES):
        yield from (f"{a} stands below {b}" for a, b in arrows() if PLACES[a][1] >= PLACES[b][1])


def main() -> int:
    """Exit code 1 if the tables do not fit the code, or with --check the picture does not."""
    found = list(faults())
    if not found and sys.argv[1:] != ["--check"]:
        PICTURE.write_text(picture(), encoding="utf-8")
    elif not found and (not PICTURE.is_file() or PICTURE.read_text(encoding="utf-8") != picture()):
        found.append("docs/figures/architecture.svg is not that of the code: python scripts/architecture_picture.py")
    print(*found, sep="\n", end="\n" if found else "")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
