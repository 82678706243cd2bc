"""What against_revision.sh prints: ratios of CPU times, or numbers that differ.

python benchmarks/revision/report.py times FILE         lines: NAME JSON, NAME one of here, revision, again
python benchmarks/revision/report.py results HERE REVISION
"""

from __future__ import annotations

import json
import re
import statistics
import sys
from collections import Counter, defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import Any

# Not results: times, and what says where a number comes from.
APART = re.compile(r"seconds|hash|provenance|worker")
SHOWN = 20  # differing numbers that are listed


def print_times(lines: list[str]) -> None:
    """Median CPU seconds of each stage and their ratios."""
    times: dict[str, dict[str, list[float]]] = defaultdict(lambda: defaultdict(list))
    for line in lines:
        name, _, document = line.partition(" ")
        for stage, seconds in json.loads(document).items():
            times[stage][name].append(seconds)
    print(f"| stage, CPU s (median of {len(lines) // 3}) | here | revision | here / revision | revision / itself |")
    print("| --- | --- | --- | --- | --- |")
    for stage, of in times.items():
        here, revision, again = (statistics.median(of[name]) for name in ("here", "revision", "again"))
        print(f"| {stage} | {here:.3f} | {revision:.3f} | {here / revision:.3f} | {again / revision:.3f} |")


def leaves(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Numbers and texts of a document by path, without what stands apart."""
    if isinstance(value, dict | list):
        items = value.items() if isinstance(value, dict) else enumerate(value)
        for key, item in items:
            if not APART.search(str(key)):
                yield from leaves(item, f"{path}.{key}".lstrip("."))
    else:
        yield path, value


def print_differences(here: Any, revision: Any) -> int:
    """Lists what differs; returns the number of values that both have and that differ."""
    ours, theirs = dict(leaves(here)), dict(leaves(revision))
    for name, only in (("here", ours.keys() - theirs.keys()), ("revision", theirs.keys() - ours.keys())):
        for path, count in sorted(Counter(re.sub(r"\.\d+\b", "[]", path) for path in only).items()):
            print(f"only {name}: {path} ({count} times)")
    differing = [path for path in ours if path in theirs and ours[path] != theirs[path]]
    for path in differing[:SHOWN]:
        print(f"{path}: {ours[path]!r} here, {theirs[path]!r} in the revision")
    common = len(ours.keys() & theirs.keys())
    print(f"{len(differing)} of {common} values differ" if differing else f"all {common} values are the same bits")
    return len(differing)


def main() -> int:
    """Exit code 1 if results differ."""
    kind, *files = sys.argv[1:]
    if kind == "times":
        print_times(Path(files[0]).read_text().splitlines())
        return 0
    here, revision = (json.loads(Path(file).read_text()) for file in files)
    return 1 if print_differences(here, revision) else 0


if __name__ == "__main__":
    sys.exit(main())
