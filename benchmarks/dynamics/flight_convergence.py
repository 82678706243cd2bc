"""How the objectives of a flight converge: `rms` family, standard study, repaired inertias, trajectory 1.

    python benchmarks/dynamics/flight_convergence.py [--control-step 0.004]

Two statements, because the controller is a sampled one. *Loop*: plant, jets, references and controller at steps of
8, 4, 2 and 1 ms, starting without the published free fall of one step (whose velocity error m g h is part of the
objective, and of first order itself). *Plant*: the controller keeps its step, only the integrator between its samples
is refined. Printed: objective differences of successive halvings and the orders they imply.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

REPOSITORY = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(REPOSITORY / "tests" / "python"))

import ironcub_flight  # noqa: E402
from codesign import dynamics as dyn  # noqa: E402
from codesign import load_study  # noqa: E402

DESIGN = {"angle": 15, "distance": 42, "offset": 80, "length": 108}


def fly(model: dyn.Model, step: float, substeps: int, integrator: dyn.Integrator, free_fall: bool) -> np.ndarray:
    """Objectives `rms` of one flight: momentum, joint velocity, thrust."""
    settings = ironcub_flight.settings(1)
    settings.step = step
    settings.substeps = substeps
    settings.integrator = integrator
    settings.initial_free_fall = free_fall
    log = dyn.simulate_flight(model, settings)
    if not log.completed:
        raise SystemExit(f"flight lost: {log.failure_reason} at {log.failure_time} s")
    return np.array([log.rms.momentum, log.rms.joint_velocity, log.rms.thrust])


def report(title: str, steps: list[float], objectives: list[np.ndarray]) -> None:
    differences = np.diff(np.array(objectives), axis=0)
    orders = np.log2(np.abs(differences[:-1] / differences[1:]))
    print(f"\n{title}\n{'step [ms]':>18}{'momentum':>24}{'joint velocity':>24}{'thrust':>24}")
    print(f"{1e3 * steps[0]:18.4g}" + "".join(f"{value:24.9g}" for value in objectives[0]))
    for k, difference in enumerate(differences):
        shown = [f"{d:+.3e}" for d in difference]
        if k > 0:
            shown = [f"{text} (order {order:.2f})" for text, order in zip(shown, orders[k - 1], strict=True)]
        print(f"{1e3 * steps[k + 1]:18.4g}" + "".join(f"{text:>24}" for text in shown))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--control-step", type=float, default=0.004, help="of the plant's refinement [s]")
    control = parser.parse_args().control_step
    model = dyn.load_urdf(load_study("ironcub_paper").build_robot(DESIGN), joints=ironcub_flight.JOINTS)
    loop_steps = [0.008, 0.004, 0.002, 0.001]
    for free_fall in (False, True):
        for integrator in (dyn.Integrator.euler, dyn.Integrator.semi_implicit_euler):
            start = "with" if free_fall else "without"
            flown = [fly(model, step, 1, integrator, free_fall) for step in loop_steps]
            report(f"loop, {integrator.name}, {start} the free fall", loop_steps, flown)
    substeps = {dyn.Integrator.runge_kutta_4: [1, 2, 4, 8], dyn.Integrator.euler: [1, 2, 4, 8, 16, 32]}
    for integrator, counts in substeps.items():
        flown = [fly(model, control, count, integrator, True) for count in counts]
        title = f"plant, {integrator.name}, control every {1e3 * control:g} ms"
        report(title, [control / count for count in counts], flown)


if __name__ == "__main__":
    main()
