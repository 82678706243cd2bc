"""Propellers and their motors by similarity, and own numbers of the study; `python propeller.py` prints study.toml's.

Momentum theory and the similarity of propellers: a propeller of diameter D at n revolutions per second has the thrust
T = c_T ρ n² D⁴ and takes the power P = c_P ρ n³ D⁵, so its drag torque is Q = P / (2π n) = c_P / (2π c_T) D T. The
ideal power is T √(T / (2 ρ A)), A the disk; over the figure of merit it is P, so c_P = √(2/π) c_T^1.5 / FM. The
coefficients are assumed, of the size known of small two-blade propellers at rest (see J. B. Brandt and M. S. Selig,
"Propeller Performance Data at Low Reynolds Numbers", AIAA 2011-1255): put in those of yours. All motors reach the
same largest thrust, so larger propellers turn slower and need more torque; a motor's mass goes with its torque, a
propeller's with its volume, and the lengths of both with the diameter, as the robot's rotors are drawn.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Mapping
from typing import Any

AIR_DENSITY = 1.225  # kg/m³
THRUST_COEFFICIENT, FIGURE_OF_MERIT = 0.11, 0.6
ROTORS, INCH = 6, 0.0254
MAX_THRUST = 12.0  # N, of every motor with its propeller
HUB_RADIUS, TIP_GAP = 0.08, 0.02  # m: axis to the mounts in robot.toml; at least, between disks of neighbors
SEAT_HEIGHT, TILTS = 0.015, (15.0, 32.5)  # m, over the axis of the thickest arm; deg, of [variables.tilt]
MOTOR_MASS, MOTOR_RADIUS, MOTOR_HEIGHT = 0.4, 0.055, 0.118  # kg per N m of its torque; of the diameter
PROPELLER_MASS, PROPELLER_HEIGHT = 0.7, 0.134  # kg/m³ of D³; of the diameter, above the seat
LAG, LAG_DIAMETER = 0.05, 0.254  # s, of a propeller of that diameter [m]; inertia times speed over torque goes with D²
POWER_COEFFICIENT = math.sqrt(2.0 / math.pi) * THRUST_COEFFICIENT**1.5 / FIGURE_OF_MERIT


def diameter(name: str) -> float:
    """[m] of a propeller by its name in study.toml: `10in`."""
    return float(name.removesuffix("in")) * INCH


def drag_torque(size: float) -> float:
    """Torque per thrust [N m/N] of a propeller of a diameter [m]."""
    return float(POWER_COEFFICIENT / (2.0 * math.pi * THRUST_COEFFICIENT) * size)


def revolutions(thrust: float, size: float) -> float:
    """[1/s] at which a propeller of a diameter [m] has a thrust [N]."""
    return math.sqrt(thrust / (THRUST_COEFFICIENT * AIR_DENSITY * size**4))


def power(thrust: float, size: float) -> float:
    """[W] that a propeller of a diameter [m] takes for a thrust [N]."""
    return float(POWER_COEFFICIENT * AIR_DENSITY * revolutions(thrust, size) ** 3 * size**5)


def motor_and_propeller(size: float) -> tuple[float, float]:
    """Masses [kg] for a propeller of a diameter [m]."""
    return MOTOR_MASS * MAX_THRUST * drag_torque(size), PROPELLER_MASS * size**3


def body(size: float) -> tuple[float, float, float, float]:
    """Mass [kg], height of its center over the seat [m], moments of inertia about that, across and along [kg m²]."""
    motor, blades = motor_and_propeller(size)
    radius, height, above = MOTOR_RADIUS * size, MOTOR_HEIGHT * size, PROPELLER_HEIGHT * size
    mass = motor + blades
    center = (motor * height / 2.0 + blades * above) / mass
    across = motor * ((3.0 * radius**2 + height**2) / 12.0 + (height / 2.0 - center) ** 2)
    across += blades * (size**2 / 24.0 + (above - center) ** 2)  # a turning rod, averaged
    return mass, center, across, motor * radius**2 / 2.0 + blades * size**2 / 12.0


def spread(size: float, tilt: float) -> float:
    """[m] between the mounts' ends of neighbors, 60 deg apart, that leaves the gap between their disks; tilt [deg].

    Every second pair leans together, mirror images of each other: what is nearest lies on the line between them.
    """
    lean = math.cos(math.radians(30.0)) * math.sin(math.radians(tilt))  # of a propeller's axis towards the other
    return TIP_GAP + 2.0 * (SEAT_HEIGHT + PROPELLER_HEIGHT * size) * lean + size * math.sqrt(1.0 - lean**2)


def arm_length(size: float) -> float:
    """[m] that leaves the gap at all tilts; neighbors are as far apart as from the hub's axis; up to 5 mm more."""
    lowest, highest = TILTS
    needed = max(spread(size, lowest + (highest - lowest) * k / 100) for k in range(101))
    return math.ceil((needed - HUB_RADIUS) / 0.005 - 1e-9) * 0.005


def choice(inches: int) -> str:
    """A propeller as study.toml has it."""
    size = inches * INCH
    mass, center, across, along = body(size)
    part = "parts.arm.masses.0"
    entries = (
        f"diameter = {1e3 * size:.1f}",
        f"length = {1e3 * arm_length(size):.1f} # of the arm",
        f'"{part}.mass_kg" = {mass:.4f}',
        f'"{part}.point_mm.2" = {1e3 * center:.2f}',
        *(f'"{part}.inertia_kg_m2.{k}" = {value:.3e}' for k, value in enumerate((across, across, along))),
        f'"flight.jets.reaction_n_m_per_n" = {drag_torque(size):.5f}',
        f'"flight.jets.lag_s" = {LAG * (size / LAG_DIAMETER) ** 2:.4f}',
    )
    return "\n".join((f"[variables.propeller.choices.{inches}in]", *entries, ""))


def hover_thrust(document: Mapping[str, Any]) -> float:
    """[N] of a rotor, mean over the flight."""
    flight = document["flight"]
    return float(flight["thrust_impulse"]) / float(flight["duration"]) / ROTORS


def power_in_watts(document: Mapping[str, Any]) -> float:
    """Of all propellers at the mean thrust of the flight."""
    return ROTORS * power(hover_thrust(document), diameter(document["design"]["propeller"]))


def mass_in_kg(document: Mapping[str, Any]) -> float:
    """Of the arms with their motors and propellers, to the gram: finer ones are the facets' and decide nothing."""
    rotor = sum(motor_and_propeller(diameter(document["design"]["propeller"])))
    return round(ROTORS * (float(document["parts"]["arm"]["mass"]) + rotor), 3)


def frequency_over_revolutions(document: Mapping[str, Any]) -> float:
    """First frequency of an arm over the propellers' revolutions per second in hover, to a twentieth.

    At 1 they shake it to pieces. Meshes differ by a thousandth, which must not make a design a best compromise.
    """
    turns = revolutions(hover_thrust(document), diameter(document["design"]["propeller"]))
    return round(20.0 * float(document["parts"]["arm"]["first_frequency"]) / turns) / 20.0


if __name__ == "__main__":
    sys.stdout.write("\n".join(choice(inches) for inches in range(8, 14)))
