"""Every number that an evaluation may hold, by path: what objectives and limits may name, and what a page lists.

A word in capitals stands for a name of the study (PART, CASE, JOINT) or an index (N). Tests compare the table with the
documents of evaluations, in both directions.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace

from codesign.problem.quantities import FAMILY, QUANTITIES, quantity

JOINTS = "joints"  # without moving joints these numbers are always 0
TANK = "tank"  # without [flight.tank] always 0
FUEL = "fuel"  # there only with what the jets burn
GROUND = "ground"  # there only with [flight.ground]
CLEARANCES = "clearances"  # there only with [interference]
SEEDS = "seeds"  # there only with several seeds
FLOWN_CASE = "flown case"  # there only of load cases whose loads the flight gives
ASKED = "asked"  # computed where an objective or a limit names it
ALWAYS_ZERO = {JOINTS: "the robot moves no joints", TANK: "there is no [flight.tank]"}
MISSING = {
    FUEL: "[flight.fuel], what the jets burn",
    GROUND: "[flight.ground]",
    CLEARANCES: "[interference]",
    SEEDS: "several flight.seeds",
    FLOWN_CASE: "a load case with `flown`",
}
WILD = re.compile(r"[A-Z]+")


@dataclass(frozen=True, slots=True)
class Number:
    """A number of the evaluation's document. needs: what the study must have for it to be there, or to vary."""

    path: str
    unit: str
    meaning: str
    needs: str = ""

    def matches(self, path: str) -> bool:
        """Whether a path is one of this number's; its steps may be `*`."""
        steps, own = path.split("."), self.path.split(".")
        return len(steps) == len(own) and all(
            bool(step) if WILD.fullmatch(mine) else step == mine for step, mine in zip(steps, own, strict=True)
        )


def _all(prefix: str, *rows: tuple[str, ...]) -> list[Number]:
    return [Number(f"{prefix}.{row[0]}", *row[1:]) for row in rows]


_STRENGTH = (
    ("safety_factor", "", "yield strength over peak stress"),
    ("peak_stress", "Pa", "largest von Mises stress outside of the zones that are left out"),
    ("peak_position.N", "m", "where it is, part axes"),
    ("stress_error", "Pa", "estimated error of the peak stress"),
    ("stress_50", "Pa", "von Mises stress that is exceeded in 50 mm³: hardly depends on the mesh, is not conservative"),
    ("left_out.stress", "Pa", "largest stress in the zones that are left out"),
    ("left_out.position.N", "m", "where it is, part axes"),
    ("left_out.border_distance", "m", "its distance from the border of supports, loads or sharp edges"),
    ("border_distance", "m", "of the peak from the nearest clamp or load"),
    ("max_displacement", "m", "largest displacement under the load"),
    ("work", "J", "of the loads; twice the strain energy"),
    ("time", "s", "of the flight, when a flown load case governs", FLOWN_CASE),
    ("seed", "", "of the flight in which it does", FLOWN_CASE),
)
_PART = (
    ("mass", "kg", "of the part"),
    ("com.N", "m", "center of mass, part axes"),
    ("inertia.N.N", "kg·m²", "about the center of mass, part axes"),
    *_STRENGTH,
    ("first_frequency", "Hz", "lowest natural frequency on the supports, with carried masses", ASKED),
    ("frequencies.N", "Hz", "the lowest natural frequencies", ASKED),
    ("buckling_factor", "", "multiple of the load at which the part buckles", ASKED),
    ("refinements", "", 'times that the mesh was refined, with `accuracy = "converged"`'),
    ("change", "", 'relative change of the peak in the last refinement, with `accuracy = "converged"`'),
    ("nodes", "", "of the mesh"),
    ("tetrahedra", "", "of the mesh"),
    ("seconds.mesh", "s", "processor time of the mesh"),
    ("seconds.solve", "s", "processor time of the solution"),
)
_CASE = (
    *_STRENGTH,
    ("change", "", 'relative change of its peak in the last refinement there, with `accuracy = "converged"`'),
    ("fatigue.damage", "", "Miner's sum of one flight", FLOWN_CASE),
    ("fatigue.flights", "", "until the part fails by fatigue", FLOWN_CASE),
    ("fatigue.position.N", "m", "where it would, part axes", FLOWN_CASE),
)
_FLIGHT = (
    ("duration", "s", "that was flown"),
    ("max_com_error", "m", "largest distance of the center of mass from its reference"),
    ("max_attitude_error", "rad", "largest angle between the base and its reference"),
    ("tracking", "m", "root mean square of the distance of the center of mass from its reference"),
    ("tracking_attitude", "rad", "root mean square of the attitude error"),
    ("tracking_pose", "m", "root mean square of position and attitude error, a radian counted as a meter"),
    ("final_com_error", "m", "distance of the center of mass from its reference at the end"),
    ("min_thrust", "N", "smallest thrust of a jet"),
    ("max_thrust", "N", "largest thrust of a jet"),
    ("thrust_impulse", "N·s", "integral of the total thrust"),
    ("hover_margin", "", "1 less the largest share of its limit that a jet needs to hover at the start"),
    ("max_torque", "N·m", "largest torque of a joint", JOINTS),
    ("mechanical_energy", "J", "sum over the joints of the integral of |torque · velocity|", JOINTS),
    ("positive_energy", "J", "the same where the joint drives, not brakes", JOINTS),
    ("joints.JOINT.peak_torque", "N·m", "of a joint", JOINTS),
    ("joints.JOINT.peak_speed", "rad/s", "of a joint", JOINTS),
    ("joints.JOINT.peak_power", "W", "of a joint", JOINTS),
    ("fuel", "kg", "burnt by all jets, by their consumption", FUEL),
    ("fuel_burnt", "kg", "by which the tank is lighter at the end", TANK),
    ("min_clearance", "m", "smallest height of the ground points", GROUND),
    ("saturation.thrust_rate_share", "", "mean thrust rate over its limit"),
    ("saturation.thrust_at_most", "", "share of the time at the largest thrust"),
    ("saturation.thrust_at_least", "", "share of the time at the smallest thrust"),
    ("saturation.torque_at_limit", "", "share of the time at the largest torque", JOINTS),
    ("saturation.joint_at_limit", "", "share of the time in which a joint is driven into its end", JOINTS),
    ("qp_failures", "", "control steps without a solution"),
    ("missed_share", "", "share of the flight that a lost one did not last; 0: completed"),
    ("failure_time", "s", "when a lost flight was lost; not there of others"),
    ("seconds", "s", "processor time"),
    ("seeds.N.seed", "", "of one of several flights", SEEDS),
    ("seeds.N.max_thrust", "N", "of one of several flights", SEEDS),
    ("seeds.N.max_attitude_error", "rad", "of one of several flights", SEEDS),
    ("seeds.N.rms.momentum", "", "of one of several flights", SEEDS),
    ("seeds.N.rms.joint_velocity", "rad/s", "of one of several flights", SEEDS),
    ("seeds.N.rms.thrust", "N", "of one of several flights", SEEDS),
    ("interference.body_clearance", "m", "smallest gap beside the parts", CLEARANCES),
    ("interference.plume_clearance", "m", "smallest gap beside the jets", CLEARANCES),
    ("interference.bodies.N.clearance", "m", "of a pair of links", CLEARANCES),
    ("interference.bodies.N.time", "s", "of a pair of links: when", CLEARANCES),
    ("interference.plumes.N.clearance", "m", "of a jet and a link", CLEARANCES),
    ("interference.plumes.N.angle", "rad", "of a jet and a link", CLEARANCES),
    ("interference.plumes.N.time", "s", "of a jet and a link: when", CLEARANCES),
)


def _families() -> Iterator[Number]:
    for family in ("rms", "script", "paper"):
        for member in FAMILY:
            meaning = f'`{member}` as `objectives.family = "{family}"` has it'
            needs = JOINTS if member == "joint_velocity" else ""
            yield Number(f"objective_families.{family}.{member}", quantity(member, family).unit, meaning, needs)


NUMBERS = (
    *_all("parts.PART", *_PART),
    *_all("parts.PART.cases.CASE", *_CASE),
    *_all("flight", *_FLIGHT),
    *_families(),
)


def known_number(name: str) -> Number | None:
    """What is known of a number by its short name, path, or reduced path `sum(parts.*.mass)`; None: nothing."""
    if name in FAMILY:
        found = known_number(f"objective_families.rms.{name}")
        return found and replace(found, path=name)
    short = QUANTITIES.get(name)
    path = (short.path or f"flight.interference.{name}") if short else name
    path = re.sub(r"^(?:min|max|sum)\((.*)\)$", r"\1", path)
    return next((number for number in NUMBERS if number.matches(path)), None)


def number_names(prefix: str) -> list[str]:
    """Paths that begin as `prefix` does, a word in capitals for what is named or counted."""
    return [number.path for number in NUMBERS if number.path.startswith(prefix)]
