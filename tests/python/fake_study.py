"""A cheap study with the interface of codesign.study.Study, for tests of everything around an evaluation.

`source` is a JSON object: seconds (time of an evaluation), jitter (random time on top), faults (grid point "0,1,2" ->
what it does to its process), levels, log (a file that gets a line per evaluation), hash, execution, unconstrained (all
designs are feasible), libraries (versions of its identity), by_trajectory (the trajectory's name decides, too).
"""

from __future__ import annotations

import ctypes
import hashlib
import json
import os
import random
import signal
import sys
import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from codesign.problem.design_space import DesignSpace, Variable
from codesign.problem.evaluation import Evaluation
from codesign.problem.identity import Identity
from codesign.problem.pareto import rival_of


@dataclass(frozen=True)
class Optimizer:
    population: int = 8
    generations: int = 5
    evaluations: int | None = None
    crossover_probability: float = 0.9
    mutation_probability: float = 0.25
    algorithm: str = "nsga2"
    seed: int = 1


@dataclass(frozen=True)
class Execution:
    workers: int = 2
    time_limit_s: float = 20.0
    memory_limit_mib: int = 400
    lazy: bool | None = None


class FakeStudy:
    name = "fake"
    loader = "fake_study:load"
    objectives = ("near", "far")

    def __init__(self, source: str) -> None:
        options: dict[str, Any] = json.loads(source)
        self.source = source
        self.hash = options.get("hash") or hashlib.sha256(source.encode()).hexdigest()[:16]
        self.identity = Identity({"source": self.hash}, options.get("libraries", {}))
        self.seconds = options.get("seconds", 0.0)
        self.jitter = options.get("jitter", 0.0)
        self.faults = options.get("faults", {})
        self.by_trajectory = options.get("by_trajectory", False)
        self.unconstrained = options.get("unconstrained", False)
        self.log = options.get("log")
        levels = options.get("levels", [21, 11, 6])
        self.space = DesignSpace(
            tuple(Variable(name, 0.0, 0.5 * (n - 1), 0.5, "mm") for name, n in zip("abcdefgh", levels, strict=False))
        )
        self.execution = Execution(**options.get("execution", {}))
        self.optimizer = Optimizer(**options.get("optimizer", {}))

    def evaluate(self, design: Any, trajectory: str | None = None, cache: Any = None) -> Evaluation:
        design = dict(design)
        x = [design[v.name] / v.maximum if v.maximum else 0.0 for v in self.space.variables]
        if self.log:
            with Path(self.log).open("a") as file:
                file.write(",".join(map(str, self.space.indices(design))) + "\n")
        time.sleep(self.seconds + self.jitter * random.random())
        misbehave(self.faults.get(",".join(map(str, self.space.indices(design)))))
        near = sum((v - 0.1) ** 2 for v in x) / 3.0
        if self.by_trajectory:
            near += len(trajectory or "") + int((trajectory or "0")[-1])
        far = sum((v - 0.9) ** 2 for v in x) / 3.0
        margin = 1.6 - x[0] - x[1]
        if self.faults.get(",".join(map(str, self.space.indices(design)))) == "nan":
            near = float("nan")
        part = {"mass": x[0] / 3.0, "seconds": {"mesh": time.perf_counter()}}
        infeasible = margin < 0 and not self.unconstrained
        return Evaluation(
            design=self.space.design(design).to_dict(),
            status="infeasible" if infeasible else "feasible",
            objectives={} if infeasible else {"near": near, "far": far},
            constraints={"margin": margin},
            violations={"margin": max(0.0, -margin) if infeasible else 0.0},
            parts={"part": part},
            flight={"trajectory": trajectory},
            seconds={"total": time.perf_counter()},
        )


class LazyStudy(FakeStudy):
    """Tells early that a design will not enter the front; its constraint is known late."""

    loader = "fake_study:load_lazy"

    def evaluate_lazily(self, design: Any, rivals: Any, /, cache: Any = None) -> Evaluation:
        whole = self.evaluate(design, cache=cache)
        rival = rival_of(rivals, whole.objectives.values()) if whole.objectives else None
        if rival is None:
            return whole
        return replace(
            whole, status="skipped", reason=f"not computed, see {rival}", constraints={}, violations={}, parts={}
        )


def misbehave(fault: str | None) -> None:
    if fault is None:
        return
    if fault == "raise":
        raise RuntimeError("no such luck")
    if fault == "exit":
        sys.exit(3)
    if fault == "hard exit":
        os._exit(7)
    if fault == "segfault":
        ctypes.string_at(0)
    if fault == "abort":
        os.abort()
    if fault == "loop":
        while True:
            pass
    if fault == "native loop":  # holds the interpreter's lock for ever
        ctypes.PyDLL(None).pause()
    if fault == "memory":
        hoard = []
        while True:
            hoard.append(bytearray(1 << 24))
    if fault == "killed":
        os.kill(os.getpid(), signal.SIGKILL)
    if fault == "print":
        os.write(1, b"noise on standard output\n" * 100)


def load(source: str) -> FakeStudy:
    return FakeStudy(source)


def load_lazy(source: str) -> LazyStudy:
    return LazyStudy(source)


def study(**options: Any) -> FakeStudy:
    return FakeStudy(json.dumps(options))
