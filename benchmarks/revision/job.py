"""The jobs that against_revision.sh has several revisions of codesign do; run by the Python of each.

python benchmarks/revision/job.py times            CPU seconds of each stage, one JSON document
python benchmarks/revision/job.py designs COUNT    CPU seconds a random design, all parts new
python benchmarks/revision/job.py results FILE     numbers of ten designs and of a small run, as JSON

Revisions differ in where things are, so this file looks for them in the places that they have had.
"""

from __future__ import annotations

import importlib
import json
import os
import random
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import codesign
from codesign import _core
from codesign.errors import StudyError

DESIGN = {"angle": 15, "distance": 42, "offset": 80, "length": 108}
OTHER = {"angle": 60, "distance": 60, "offset": 100, "length": 150}  # shares no part with DESIGN
THIRD = {"angle": 20, "distance": 50, "offset": 90, "length": 120}  # nor does this one, which flies to the end
PLACES = {
    "stress_settings": ("codesign.chain.chain", "codesign.pipeline"),
    "part_case": ("codesign.parts.load_case", "codesign.analysis"),
    "analyze_part": ("codesign._core",),
    "fly_robot": ("codesign.chain.fly", "codesign.pipeline"),
}
FORMER = {"analyze_part": "analyse_part"}  # names that earlier revisions had


def find(name: str) -> Callable[..., Any]:
    """The function of this name, wherever this revision has it."""
    for place in PLACES[name]:
        try:
            module = importlib.import_module(place)
        except ImportError:
            continue
        for spelling in (name, FORMER.get(name, name)):
            function: Callable[..., Any] | None = getattr(module, spelling, None)
            if function is not None:
                return function
    raise SystemExit(f"revision_job.py: this revision has no {name} in {', '.join(PLACES[name])}")


def cpu(call: Callable[[], object]) -> float:
    """CPU seconds, user and system, of all threads."""
    start = time.process_time()
    call()
    return time.process_time() - start


def child_cpu(*arguments: str) -> float:
    """CPU seconds of this Python with arguments, from its start to its end."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([sys.executable, "-P", *arguments], check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


class Kept(dict[str, Any]):
    """A cache of parts in memory."""

    put = dict.__setitem__


def published_study() -> codesign.Study:
    """The study as published, which older revisions call ironcub."""
    try:
        return codesign.load_study("ironcub_paper")
    except StudyError:
        return codesign.load_study("ironcub")


def times() -> dict[str, float]:
    """CPU seconds of each stage; every stage starts from nothing known."""
    study = published_study()
    parts = study.build_parts(DESIGN)
    cases = {n: find("part_case")(p, find("stress_settings")(study.config, n)) for n, p in parts.items()}
    seconds = {
        "start: load the study": child_cpu("-c", f"import codesign; codesign.load_study({study.name!r})"),
        "start: codesign --help": child_cpu(str(Path(sys.executable).with_name("codesign")), "--help"),
    }
    fresh = study.build_parts(OTHER).values()
    seconds["both parts: surface and mass"] = cpu(lambda: [(p.surface(), p.mass_properties()) for p in fresh])
    seconds |= {f"{n}: surface to stress": cpu(lambda c=c: find("analyze_part")(c)) for n, c in cases.items()}
    robot = study.build_robot(DESIGN)
    seconds["flight of 42 s"] = cpu(lambda: find("fly_robot")(study, robot))
    seconds["evaluate, cold"] = cpu(lambda: study.evaluate(THIRD))
    cache = Kept()
    study.evaluate(THIRD, cache=cache)
    seconds["evaluate, parts known"] = cpu(lambda: study.evaluate(THIRD, cache=cache))
    return seconds


def random_designs(study: codesign.Study, count: int) -> list[dict[str, Any]]:
    """Of the study's grid, always the same."""
    draw = random.Random(1)
    grids = [[draw.randrange(levels) for levels in study.space.levels] for _ in range(count)]
    return [study.space.from_indices(grid).to_dict() for grid in grids]


def designs(count: int) -> dict[str, float]:
    """CPU seconds a random design: surfaces and masses, each part from its case to its stress, the whole evaluation.

    Nothing is cached; a revision that keeps meshes and factors in its processes may keep as much as in a worker of a
    run. Surfaces and masses are those of a process of their own.
    """
    study = published_study()
    thetas = random_designs(study, count)
    worker_keeps()
    alone = subprocess.run([sys.executable, "-P", __file__, "surfaces", str(count)], check=True, stdout=subprocess.PIPE)
    seconds: dict[str, float] = json.loads(alone.stdout)
    for name in study.build_parts(thetas[0]):
        forget()
        settings = find("stress_settings")(study.config, name)
        parts = [study.build_parts(theta)[name] for theta in thetas]
        stage = cpu(lambda parts=parts, settings=settings: [_analyzed(part, settings) for part in parts])
        seconds[f"{name}: case to stress"] = stage / count
    forget()
    seconds["evaluate"] = cpu(lambda: [study.evaluate(theta) for theta in thetas]) / count
    return seconds


def surfaces(count: int) -> dict[str, float]:
    """CPU seconds a random design: surfaces and masses of its parts, from the start of a process on."""
    study = published_study()
    parts = [part for theta in random_designs(study, count) for part in study.build_parts(theta).values()]
    whole = cpu(lambda: [(part.surface(), part.mass_properties()) for part in parts])
    return {"both parts: surface and mass": whole / count}


def _analyzed(part: Any, settings: Any) -> None:
    find("analyze_part")(find("part_case")(part, settings))


def worker_keeps() -> None:
    """What a worker of a run may keep of meshes and factors, where a revision keeps any."""
    if hasattr(_core, "limit_kept_meshes"):
        pool = importlib.import_module("codesign.execution.pool")
        _core.limit_kept_meshes(pool.kept_mib(2) * 2.0**20)


def forget() -> None:
    """Frees what is kept of parts before."""
    if hasattr(_core, "forget_meshes"):
        _core.forget_meshes()


def results() -> dict[str, Any]:
    """Every document of ten designs and of a run of 12 designs over 3 generations."""
    study = published_study()
    evaluations = [study.evaluate(design).to_dict() for design in random_designs(study, 10)]
    with tempfile.TemporaryDirectory() as folder:
        run = codesign.optimize(
            study, out=Path(folder) / "run", population=12, generations=3, seed=1, workers=1, cache=None
        )
        rows = [evaluation.to_dict() for evaluation in run.evaluations]
    return {"evaluate": evaluations, "optimize": rows}


def main() -> None:
    """Does the job that the arguments name."""
    sys.stderr.write(f"{Path(codesign.__file__).parent}, {Path(_core.__file__)}\n")
    if sys.argv[1] == "times":
        print(json.dumps(times()))
    elif sys.argv[1] == "surfaces":
        print(json.dumps(surfaces(int(sys.argv[2]))))
    elif sys.argv[1] == "designs":
        print(json.dumps(designs(int(sys.argv[2]))))
    else:
        Path(sys.argv[2]).write_text(json.dumps(results()))


if __name__ == "__main__":
    os.environ.setdefault("CODESIGN_CACHE", tempfile.gettempdir())
    main()
