"""Checks that C++ files include downwards only (docs/architecture.md); prints every include that does not.

Usage: check_includes.py [FOLDER], default cpp/ of the repository.
"""

import re
import sys
from collections.abc import Iterator
from pathlib import Path

# A folder may include those further down in its list, of its own line none but itself; fem is part_analysis.
LAYERS = (
    ("bindings",),
    ("fem", "dynamics/flight"),
    ("fem/elasticity", "dynamics/predictive", "dynamics/urdf"),
    ("fem/stress", "dynamics"),
    ("fem/la",),
    ("fem/boundary", "fem/meshing", "fem/smoothing"),
    ("fem/mesh",),
    ("fem/surface",),
    ("base", ""),
)
RANK = {folder: rank for rank, folders in enumerate(LAYERS) for folder in folders}
# Libraries that only some folders see, and no header outside of the bindings.
LIBRARIES = {
    r"CGAL/": ("fem/meshing", "fem/smoothing", "fem/surface"),
    r"(cholmod|SuiteSparse\w*)\.h": ("fem/la",),
    r"expat\.h": ("dynamics/urdf",),
    r"urdf_(model|parser)/": ("dynamics/urdf",),
    r"pybind11/": ("bindings",),
}


def layer(path: str) -> str:
    """The folder of LAYERS that holds a file; a sub-folder that is not listed belongs to the folder above it."""
    folder = path.rpartition("/")[0]
    while folder not in RANK:
        folder = folder.rpartition("/")[0]
    return folder


def violations(root: Path) -> Iterator[str]:
    """Includes that the layers forbid, as FILE:LINE: REASON."""
    for file in sorted(root.rglob("*.[ch]pp")):
        name = file.relative_to(root).as_posix()
        here = layer(name)
        for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
            match = re.match(r'\s*#\s*include\s*(["<])([^">]+)', line)
            if match is None:
                continue
            included = match[2]
            there = layer(included)
            robot_and_parts = {here.partition("/")[0], there.partition("/")[0]} == {"fem", "dynamics"}
            if match[1] == '"' and here != there and (robot_and_parts or RANK[there] <= RANK[here]):
                yield f"{name}:{number}: {here or 'cpp'} must not include {included}"
            for pattern, folders in LIBRARIES.items():
                if re.match(pattern, included) and (
                    here not in folders or (file.suffix == ".hpp" and here != "bindings")
                ):
                    yield f"{name}:{number}: {included} belongs into sources of {', '.join(folders)}"


def main() -> int:
    """Exit code 1 if there is a violation."""
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parents[1] / "cpp"
    found = list(violations(root))
    print(*found, sep="\n", end="\n" if found else "")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
