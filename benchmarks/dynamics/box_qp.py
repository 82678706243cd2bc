"""The box QP solver: certificates on hard problems, time on the problems of the flight loop.

    python benchmarks/dynamics/box_qp.py [--problems 10000] [--repeats 7]

1. Random and adversarial problems of 1 to 60 variables (condition numbers to 1e10, equal and infinite bounds,
   degenerate vertices), each solved cold and warm-started from another problem's working set: the KKT residual is
   recomputed here.
2. The momentum QPs of the standard study's flight in their order, n = 27. Native: time of the solver inside the
   flight loop, from the flight's profile. From Python: CPU time per call, warm-started, against quadprog and ProxQP
   (warm-started with its own update()). quadprog takes bounds as rows of constraints; its matrices and right-hand
   sides are prepared before the clock starts. All Python calls pay for the call; for quadprog and for us that share is
   measured with a problem of one variable and printed.
Needs quadprog and proxsuite, and a release build.
"""

import argparse
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import proxsuite
import quadprog

REPOSITORY = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(REPOSITORY / "tests" / "python"))

import ironcub_flight  # noqa: E402
from codesign import dynamics as dyn  # noqa: E402
from codesign import load_study  # noqa: E402

DESIGN = {"angle": 15, "distance": 42, "offset": 80, "length": 108}
Problem = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]


def random_problem(rng: np.random.Generator, n: int) -> Problem:
    """H, g, lower, upper of one of eight families."""
    family = rng.integers(8)
    q, _ = np.linalg.qr(rng.standard_normal((n, n)))
    half = q * np.sqrt(np.geomspace(1.0, 1e2 if family % 2 == 0 else 1e10, n))
    H = half @ half.T
    if family in (6, 7):  # variables of very different units
        scale = 10.0 ** rng.uniform(-3, 3, n)
        H *= np.outer(scale, scale)
    H = 0.5 * (H + H.T)
    g, lower, upper = rng.uniform(-1, 1, n), -rng.random(n), rng.random(n)
    if family in (2, 3):
        equal, low, high = rng.random((3, n)) < 0.25
        upper = np.where(equal, lower, upper)
        lower, upper = np.where(low & ~equal, -np.inf, lower), np.where(high & ~equal, np.inf, upper)
    if family in (4, 5):  # the vertex of lower bounds solves it, two multipliers in three are zero
        g = -H @ lower
        g[::3] += np.diag(H)[::3]
    return H, g, lower, upper


def kkt_residual(problem: Problem, x: np.ndarray) -> float:
    """Largest violation of the optimality conditions, each relative to the terms of its gradient."""
    H, g, lower, upper = problem
    root = np.sqrt(np.diag(H))
    gradient = (H @ x + g) / (root * (root @ np.abs(x)) + np.abs(g) + 1e-300)
    stationarity = np.where(
        lower == upper, 0.0, np.where(x == lower, -gradient, np.where(x == upper, gradient, np.abs(gradient)))
    )
    outside = np.maximum(np.maximum(lower - x, x - upper), 0.0)
    return float(max(stationarity.max(), outside.max(), 0.0))


def certify(problems: int) -> None:
    rng = np.random.default_rng(0)
    solvers = {n: dyn.BoxQpSolver(n) for n in range(1, 61)}
    worst, unsolved, iterations = 0.0, 0, []
    for _ in range(problems):
        n = int(rng.integers(1, 61))
        problem = random_problem(rng, n)
        for result in (dyn.solve_box_qp(*problem), solvers[n].solve(*problem)):
            unsolved += result.status != dyn.QpStatus.solved
            worst = max(worst, kkt_residual(problem, result.x))
            iterations.append(result.iterations)
    print(f"{problems} random and adversarial problems, cold and warm: {unsolved} unsolved,", end=" ")
    print(f"largest KKT residual {worst:.1e}, iterations mean {np.mean(iterations):.1f} max {max(iterations)}")


def cpu_times(functions: dict[str, Callable[[], object]], calls: int, repeats: int) -> dict[str, float]:
    """Microseconds a call, best of interleaved repeats; every function makes `calls` calls."""
    best = dict.fromkeys(functions, np.inf)
    for _ in range(repeats):
        for name, function in functions.items():
            start = time.process_time()
            function()
            best[name] = min(best[name], (time.process_time() - start) / calls * 1e6)
    return best


def proxqp_of(n: int, first: Problem) -> proxsuite.proxqp.dense.QP:
    qp = proxsuite.proxqp.dense.QP(n, 0, 0, True)
    qp.settings.eps_abs = 1e-9
    qp.settings.eps_rel = 0.0
    qp.settings.initial_guess = proxsuite.proxqp.InitialGuess.WARM_START_WITH_PREVIOUS_RESULT
    H, g, lower, upper = first
    qp.init(H, g, None, None, None, None, None, l_box=lower, u_box=upper)
    qp.solve()
    return qp


def time_in_flight(repeats: int) -> None:
    model = dyn.load_urdf(load_study("ironcub_paper").build_robot(DESIGN), joints=ironcub_flight.JOINTS)
    settings = ironcub_flight.settings(1)
    logs = [dyn.simulate_flight(model, settings) for _ in range(repeats)]
    native = min(log.profile.momentum_qp for log in logs) / logs[0].samples * 1e6
    problems = [tuple(map(np.ascontiguousarray, qp)) for qp in dyn.momentum_qps(model, settings, logs[0])]
    n = len(problems[0][1])
    rows = np.hstack([np.eye(n), -np.eye(n)])
    peers = [(H, -g, rows, np.concatenate([lower, -upper])) for H, g, lower, upper in problems]
    solver, prox = dyn.BoxQpSolver(n), proxqp_of(n, problems[0])
    differences = []
    for (H, g, lower, upper), peer in zip(problems, peers, strict=True):
        x = solver.solve(H, g, lower, upper).x
        differences.append(np.abs(x - quadprog.solve_qp(*peer)[0]).max())

    def ours() -> None:
        for problem in problems:
            solver.solve(*problem)

    def theirs() -> None:
        for peer in peers:
            quadprog.solve_qp(*peer)

    def proxqp() -> None:
        for H, g, lower, upper in problems:
            prox.update(H=H, g=g, l_box=lower, u_box=upper)
            prox.solve()

    one = (np.eye(1), np.full(1, 0.1), -np.ones(1), np.ones(1))
    one_peer = (np.eye(1), np.full(1, -0.1), np.array([[1.0, -1.0]]), -np.ones(2))
    tiny = dyn.BoxQpSolver(1)
    calls = len(problems)
    times = cpu_times({"codesign": ours, "quadprog": theirs, "ProxQP": proxqp}, calls, repeats)

    def our_call() -> None:
        for _ in problems:
            tiny.solve(*one)

    def their_call() -> None:
        for _ in problems:
            quadprog.solve_qp(*one_peer)

    call = cpu_times({"codesign": our_call, "quadprog": their_call}, calls, repeats)
    print(f"{calls} momentum QPs of a flight, n = {n}, largest difference to quadprog {max(differences):.1e}")
    print(f"codesign in the flight loop (native, warm) {native:8.2f} us")
    for name, value in times.items():
        share = f", of which the call (n = 1) {call[name]:.2f} us" if name in call else ""
        print(f"{name} from Python{'':10} {value:8.2f} us{share}")
    quadprog_only = times["quadprog"] - call["quadprog"]
    print("ratios of times")
    print(f"  Python to Python: {times['codesign'] / times['quadprog']:.2f} quadprog", end=", ")
    print(f"{times['codesign'] / times['ProxQP']:.2f} ProxQP")
    print(f"  in the flight loop to quadprog from Python: {native / times['quadprog']:.2f}")
    print(f"  in the flight loop to quadprog less its call: {native / quadprog_only:.2f}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--problems", type=int, default=10000)
    parser.add_argument("--repeats", type=int, default=7)
    options = parser.parse_args()
    certify(options.problems)
    time_in_flight(options.repeats)


if __name__ == "__main__":
    main()
