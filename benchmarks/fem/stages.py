"""Where the CPU time of cold designs goes, stage by stage, as a Markdown table.

  python benchmarks/fem/stages.py [--study ironcub_paper] [--designs 50] [--seed 1]

Evaluates random designs one after another in one process with one thread and no cache of results. Stages of Python
are timed; what the compiled core does inside of them is divided by samples of `perf` (Linux, package linux-perf): a
sample belongs to the innermost function that a stage names. Start-up is that of new processes.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import re
import resource
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import codesign
from codesign import _core
from codesign.chain import chain
from codesign.execution.pool import kept_mib
from codesign.units import MEBIBYTE

STAGES = {  # of the compiled core: words, functions whose samples count, unless a function inside of them is named too
    "surface: simplify, check": r"prepare_surface|simplify_\w+|smooth_surface",
    "mesh: Delaunay": r"delaunay_mesh",
    "mesh: improve": r"improve_tets",
    "mesh: curve, number, the rest": r"tetrahedralize|curve_edges|to_quadratic|make_tet_mesh",
    "ordering": r"order_nodes|fill_reducing_order",
    "assembly": r"assemble_stiffness|NodePattern|load_vector",
    "factorization": r"CholeskyFactor::CholeskyFactor|Substructure::Substructure|CondensedFactor::CondensedFactor",
    "solution": r"CholeskyFactor::solve\w*|StaticSystem::Data::displace|CondensedFactor::solve",
    "recovery: stress, peak, error": r"read_results?|recover\w+|StaticSystem::solve\w*|exclusion_zone",
    "flight": r"simulate_flights?|FlightModel|read_urdf|reduce_urdf",
    "other work on parts": r"analyze_part",
}
TIMED = {  # functions of the chain, timed as a whole
    "make": "parts, masses, robot",
    "part_case": "surface and load cases of the parts",
    "compute": "core",
    "clearances": "clearances",
}
FREQUENCY = 499  # samples a second
STARTS = {"`codesign --help`": ["-m", "codesign.cli", "--help"], "load the study": ["-c", "{load}"]}


def designs(study: Any, count: int, seed: int) -> list[dict[str, Any]]:
    """Random designs of the grid, each part different from nearly all others."""
    draw = random.Random(seed)
    grids = [[draw.randrange(levels) for levels in study.space.levels] for _ in range(count)]
    return [study.space.from_indices(grid).to_dict() for grid in grids]


def timed(name: str, spent: dict[str, float]) -> None:
    """Replaces a function of the chain by itself with a clock."""
    function: Callable[..., Any] = getattr(chain, name)

    def clocked(*arguments: Any, **named: Any) -> Any:
        start = time.process_time()
        try:
            return function(*arguments, **named)
        finally:
            spent[name] = spent.get(name, 0.0) + time.process_time() - start

    setattr(chain, name, clocked)


def evaluate(given: argparse.Namespace) -> None:
    """The work itself: prints CPU seconds of the timed functions and of everything."""
    study = codesign.load_study(given.study)
    first, *others = designs(study, given.designs + 1, given.seed)
    _core.limit_kept_meshes(kept_mib(2) * MEBIBYTE)  # as one of two workers of a run
    study.evaluate(first)  # imports and first allocations
    spent: dict[str, float] = {}
    for name in TIMED:
        timed(name, spent)
    start = time.process_time()
    for design in others:
        study.evaluate(design)
    print(json.dumps(spent | {"all": time.process_time() - start}))


def samples(recorded: Path) -> Iterator[list[str]]:
    """Functions of each sample, the innermost first."""
    command = ["perf", "script", "--no-inline", "-F", "comm,ip,sym", "-i", str(recorded)]
    text = subprocess.run(command, check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout
    for block in text.split("\n\n"):
        if block.strip():
            yield [line.split(None, 1)[-1] for line in block.splitlines()[1:]]


def shares(recorded: Path) -> dict[str, float]:
    """Share of each stage in the samples of the core's analyses and flights."""
    named = {stage: re.compile(rf"codesign::.*\b({pattern})\b") for stage, pattern in STAGES.items()}
    found: Counter[str] = Counter()
    for functions in samples(recorded):
        for function in functions:
            stage = next((stage for stage, pattern in named.items() if pattern.search(function.split("(")[0])), None)
            if stage is not None:
                found[stage] += 1
                break
    return {stage: found[stage] / max(1, found.total()) for stage in STAGES}


def started(code: list[str]) -> float:
    """CPU seconds of a new process."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([sys.executable, "-P", *code], check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def report(given: argparse.Namespace, spent: dict[str, float], share: dict[str, float]) -> None:
    """The table."""
    rows = {TIMED[name]: spent.get(name, 0.0) / given.designs for name in TIMED if name != "compute"}
    rows |= {stage: part * spent["compute"] / given.designs for stage, part in share.items()}
    whole = spent["all"] / given.designs
    rows["judgment, documents, the rest"] = whole - sum(rows.values())
    print(
        f"\n| stage ({given.designs} cold designs of `{given.study}`) | CPU ms a design | share |\n| --- | --- | --- |"
    )
    for stage, seconds in sorted(rows.items(), key=lambda row: -row[1]):
        print(f"| {stage} | {1e3 * seconds:.1f} | {seconds / whole:.1%} |")
    print(f"| all | {1e3 * whole:.1f} | |")
    load = f"import codesign; codesign.load_study({given.study!r})"
    for words, code in STARTS.items():
        print(f"| start: {words} | {1e3 * started([part.format(load=load) for part in code]):.0f} | |")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--study", default="ironcub_paper")
    parser.add_argument("--designs", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--work", action="store_true", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.work:
        evaluate(given)
        return
    with tempfile.TemporaryDirectory() as folder:
        recorded = Path(folder) / "perf.data"
        record = ["perf", "record", "-q", "-F", str(FREQUENCY), "--call-graph", "dwarf,16384", "-o", str(recorded)]
        environment = os.environ | {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "CODESIGN_CACHE": folder}
        work = [sys.executable, *sys.argv, "--work"]
        done = subprocess.run([*record, *work], env=environment, check=True, stdout=subprocess.PIPE, text=True)
        report(given, json.loads(done.stdout.splitlines()[-1]), shares(recorded))


if __name__ == "__main__":
    main()
