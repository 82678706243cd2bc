"""Time of a 42 s flight of the standard study, and where it goes.

    python benchmarks/dynamics/flight.py [--repeats 15]

CPU time of simulate_flight on one core, best of repeats. The phases are wall times inside the loop, each the least of
all flights: on a busy machine their sum is above the CPU time, their shares still tell. Needs a release build.
"""

import argparse
import sys
import time
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(REPOSITORY / "tests" / "python"))

import ironcub_flight  # noqa: E402
from codesign import dynamics as dyn  # noqa: E402
from codesign import load_study  # noqa: E402

DESIGN = {"angle": 15, "distance": 42, "offset": 80, "length": 108}
PHASES = ("plant", "terms", "task", "momentum_qp", "torque", "log")
TARGET = 0.25  # s


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--repeats", type=int, default=15)
    repeats = parser.parse_args().repeats
    model = dyn.load_urdf(load_study("ironcub_paper").build_robot(DESIGN), joints=ironcub_flight.JOINTS)
    settings = ironcub_flight.settings(1)
    best = float("inf")
    phases = dict.fromkeys(PHASES, float("inf"))
    for _ in range(repeats):
        start = time.process_time()
        log = dyn.simulate_flight(model, settings)
        best = min(best, time.process_time() - start)
        phases = {name: min(least, getattr(log.profile, name)) for name, least in phases.items()}
    print(f"flight of {settings.duration:g} s, {log.samples} samples: {best:.3f} s of CPU, best of {repeats}")
    print(f"{best / log.samples * 1e6:.1f} us per step, {settings.duration / best:.0f} x real time; target {TARGET} s")
    for name, seconds in phases.items():
        print(f"{name:>12} {seconds / log.samples * 1e6:6.2f} us per step {seconds / sum(phases.values()):6.1%}")
    print(f"{log.total_qp_iterations / log.samples - 1:.2f} factorizations per momentum QP")


if __name__ == "__main__":
    main()
