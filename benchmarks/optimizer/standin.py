"""Stand-in studies for benchmarks of the search and of the execution: cheap objectives, chosen evaluation times.

`source` is a JSON object: problem (one of PROBLEMS), levels, seconds (mean time of an evaluation, slept), spread
(standard deviation of the time over its mean, lognormal; the time is a function of the design).
"""

from __future__ import annotations

import hashlib
import json
import math
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from codesign.problem.design_space import DesignSpace, Variable
from codesign.problem.evaluation import Evaluation
from codesign.problem.identity import Identity

Values = tuple[tuple[float, float, float], float]  # objectives, constraint violation


def smooth(a: float, b: float, c: float, d: float) -> Values:
    """Interacting bowls; feasible in a tube around the middle."""
    first = (a - 0.2) ** 2 + 0.5 * (b - 0.7) ** 2 + 0.3 * (c * d - 0.2) ** 2 + 0.1 * math.sin(6 * a * b)
    second = (a - 0.8) ** 2 + 0.6 * (b - 0.3) ** 2 + 0.2 * (d - 0.9) ** 2 + 0.3 * abs(c - 0.5)
    third = 0.3 * a + 0.4 * b + 0.5 * c + 0.2 * d + 0.1 * math.cos(9 * c)
    return (first, second, third), max(0.0, (a - 0.5) ** 2 + (b - 0.5) ** 2 - 0.25 - 0.1 * c)


def rugged(a: float, b: float, c: float, d: float) -> Values:
    """DTLZ3-like: a spherical front behind a landscape with many local minima; a diagonal band is infeasible."""
    bumps = sum((x - 0.5) ** 2 - 0.1 * math.cos(20 * math.pi * (x - 0.5)) + 0.1 for x in (c, d))
    u, v = 0.5 * math.pi * a, 0.5 * math.pi * b
    front = (math.cos(u) * math.cos(v), math.cos(u) * math.sin(v), math.sin(u))
    return (front[0] * (1 + bumps), front[1] * (1 + bumps), front[2] * (1 + bumps)), max(0.0, 0.15 - abs(a - b))


def broken(a: float, b: float, c: float, d: float) -> Values:
    """ZDT3-like: a front in pieces; a corner is infeasible."""
    g = 1 + 3 * (b + c + d)
    second = g * (1 - math.sqrt(a / g) - a / g * math.sin(10 * math.pi * a))
    return (a, second, 0.2 * (1 - b) + 0.1 * c), max(0.0, 0.3 - b - d)


PROBLEMS: dict[str, Callable[..., Values]] = {"smooth": smooth, "rugged": rugged, "broken": broken}


@dataclass(frozen=True)
class Optimizer:
    """Defaults of a search."""

    population: int = 25
    generations: int = 40
    evaluations: int | None = None
    algorithm: str = "nsga2"
    seed: int = 1
    crossover_probability: float = 0.9
    mutation_probability: float = 0.25


@dataclass(frozen=True)
class Execution:
    """Defaults of the execution."""

    workers: int = 2
    time_limit_s: float = 120.0
    memory_limit_mib: int = 0
    lazy: bool | None = None


class StandIn:
    """A study with three objectives and one constraint over four variables."""

    name = "standin"
    loader = "standin:load"
    objectives = ("first", "second", "third")
    optimizer = Optimizer()
    execution = Execution()

    def __init__(self, source: str) -> None:
        options: dict[str, Any] = json.loads(source)
        self.source = source
        self.hash = hashlib.sha256(source.encode()).hexdigest()[:16]
        self.identity = Identity({"source": self.hash})
        self.problem = PROBLEMS[options.get("problem", "smooth")]
        self.seconds, self.spread = options.get("seconds", 0.0), options.get("spread", 0.0)
        levels = options.get("levels", [79, 31, 21, 51])  # as the shipped study's
        self.space = DesignSpace(tuple(Variable(n, 0.0, k - 1.0, 1.0) for n, k in zip("abcd", levels, strict=True)))

    def duration(self, design: Mapping[str, float]) -> float:
        """Time of an evaluation [s]: lognormal over the designs."""
        if not self.spread:
            return float(self.seconds)
        digest = hashlib.sha256(json.dumps(sorted(design.items())).encode()).digest()
        u, v = (int.from_bytes(digest[i : i + 7], "big") / 2**56 for i in (0, 8))
        normal = math.sqrt(-2 * math.log(1 - u)) * math.cos(2 * math.pi * v)
        sigma = math.sqrt(math.log(1 + self.spread**2))
        return float(self.seconds * math.exp(sigma * normal - 0.5 * sigma**2))

    def evaluate(self, design: Mapping[str, float], /, **_: Any) -> Evaluation:
        """Sleeps, then gives the problem's numbers."""
        if self.seconds:
            time.sleep(self.duration(design))
        unit = [design[v.name] / v.maximum for v in self.space.variables]
        values, violation = self.problem(*unit)
        return Evaluation(
            design=dict(design),
            status="infeasible" if violation > 0 else "feasible",
            objectives=dict(zip(self.objectives, values, strict=True)),
            violations={"constraint": violation},
        )


def load(source: str) -> StandIn:
    """For worker processes."""
    return StandIn(source)


def standin(**options: Any) -> StandIn:
    """A stand-in study with these options."""
    return StandIn(json.dumps(options))
