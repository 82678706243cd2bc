"""Prints which share of the lines of the C++ libraries the tests reached, folder by folder, and the lines they did not.

Usage: cpp_coverage.py BUILD [--missing]

BUILD is a tree of the preset `coverage` after its tests have run. A line of a header is reached if it is in any of the
sources that hold it. Bindings are not counted: pytest runs those.
"""

import json
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

CPP = Path(__file__).resolve().parents[1] / "cpp"
GOAL = 90.0  # %


def counted(build: Path) -> dict[Path, dict[int, int]]:
    """File below cpp/ -> line -> how often it was run."""
    lines: dict[Path, dict[int, int]] = defaultdict(lambda: defaultdict(int))
    for notes in sorted((build / "cpp").rglob("*.gcno")):
        command = ["gcov", "--json-format", "--stdout", str(notes)]
        printed = subprocess.run(command, cwd=build, capture_output=True, text=True, check=True).stdout
        for document in map(json.loads, printed.splitlines()):
            for file in document["files"]:
                path = (Path(document["current_working_directory"]) / file["file"]).resolve()
                if path.is_relative_to(CPP):
                    for line in file["lines"]:
                        lines[path.relative_to(CPP)][line["line_number"]] += line["count"]
    return lines


def percent(counts: list[int]) -> float:
    """Share of lines that were run [%]."""
    return 100.0 * sum(count > 0 for count in counts) / max(len(counts), 1)


def main() -> int:
    """Exit code 1 below the goal."""
    lines = counted(Path(sys.argv[1]))
    if not lines:
        raise SystemExit(f"{sys.argv[1]}: no counts: cmake --preset coverage, build, ctest --preset coverage")
    folders: dict[str, list[int]] = defaultdict(list)
    for file, counts in sorted(lines.items()):
        folders[file.parent.as_posix()] += counts.values()
        if "--missing" in sys.argv[2:] and (missing := [str(n) for n, count in sorted(counts.items()) if not count]):
            print(f"cpp/{file}: {' '.join(missing)}")
    for folder, found in folders.items():
        print(f"cpp/{folder:24} {len(found):6} lines {percent(found):6.1f} %")
    total = percent([count for found in folders.values() for count in found])
    print(f"{'C++ libraries':28} {sum(map(len, folders.values())):6} lines {total:6.1f} %, goal {GOAL:g} %")
    return 1 if total < GOAL else 0


if __name__ == "__main__":
    sys.exit(main())
