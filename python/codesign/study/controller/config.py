"""Predictive control in study.toml: [flight.mpc], the servos, jet models, fuel."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from codesign.study.sections import Name, NonNegative, Positive, Section

Count = Annotated[int, Meta(ge=1, le=10_000)]
Exponent = Annotated[float, Meta(ge=-6, le=6)]
Weights3 = tuple[NonNegative, NonNegative, NonNegative]


class MpcWeightsConfig(Section, frozen=True, kw_only=True):
    """Weights of the prediction's cost; lists are x, y, z or roll, pitch, yaw. The defaults are the published ones."""

    com: Weights3 = (500.0, 500.0, 5000.0)
    com_integral: Weights3 = (25_000.0, 25_000.0, 50_000.0)
    linear_momentum: Weights3 = (1.0, 1.0, 1.5)
    attitude: Weights3 = (1000.0, 1000.0, 1000.0)
    attitude_integral: Weights3 = (10_000.0, 10_000.0, 10_000.0)
    angular_momentum: Weights3 = (80.0, 80.0, 80.0)
    joint_displacement: Positive = 65_000.0
    posture: NonNegative = 20.0
    throttle_change: Positive = 80_000.0
    throttle_first: Positive = 80_000.0


class MpcExponentsConfig(Section, frozen=True, kw_only=True):
    """Powers of ten that multiply the weights of the same name, for searches; throttle: of both throttle weights."""

    com: Exponent = 0.0
    com_integral: Exponent = 0.0
    linear_momentum: Exponent = 0.0
    attitude: Exponent = 0.0
    attitude_integral: Exponent = 0.0
    angular_momentum: Exponent = 0.0
    joint_displacement: Exponent = 0.0
    throttle: Exponent = 0.0


class MpcConfig(Section, frozen=True, kw_only=True):
    """Multi-rate predictive control: joint set points every step of the flight, throttles every few.

    small_steps, growing from one step of the flight, add up to large_step_s; large_steps follow. control_steps of them
    have inputs of their own. joint_speed_rad_s: bound on set points; None: no bound, as published. gravity_coupling:
    gravity turns with the predicted attitude; published: false. jet_dynamics, varying: false are ablations.
    """

    body: Name
    joints: list[Name]
    throttle_every: Count = 20
    small_steps: Count = 7
    large_steps: Count = 10
    large_step_s: Positive = 0.1
    control_steps: Count = 12
    joint_speed_rad_s: Positive | None = None
    integral: Literal["restart", "accumulate"] = "restart"
    gravity_coupling: bool = True
    jet_dynamics: bool = True
    varying: bool = True
    weights: MpcWeightsConfig = MpcWeightsConfig()
    weight_exponents: MpcExponentsConfig = MpcExponentsConfig()


class ServoGroupConfig(Section, frozen=True, kw_only=True):
    """Joints with the same position servo: k_p (s* - s) - k_d s', k_d = passive + 2 ratio sqrt(k_p M_jj)."""

    joints: list[Name]
    stiffness_n_m_rad: Positive
    damping_ratio: NonNegative
    passive_n_m_s_rad: NonNegative = 0.0


class ServoConfig(Section, frozen=True, kw_only=True):
    """Position servos of all joints, and how the robot with them is integrated."""

    integrator: Literal["implicit", "runge_kutta_4"] = "implicit"
    step_s: Positive = 0.001
    groups: list[ServoGroupConfig]


class StandardizedJetConfig(Section, frozen=True, kw_only=True):
    """Second-order jet identified in standardized variables T, D, U of thrust, its rate and throttle.

    T'' = thrust_scale (f + g v), v = U + B_UU U^2; f = c + K_T T + K_D D + K_TD T D + K_TT T^2 + K_DD D^2, g the same
    with B. throttle_gain: of a loop that follows a thrust rate.
    """

    thrust_mean_n: float
    thrust_scale_n: Positive
    throttle_mean_percent: float
    throttle_scale_percent: Positive
    c: float
    K_T: float
    K_D: float
    K_TD: float
    K_TT: float
    K_DD: float
    B: float
    B_T: float
    B_D: float
    B_TD: float
    B_TT: float
    B_DD: float
    B_UU: float
    max_throttle_percent: Positive = 100.0
    throttle_gain: Positive = 50.0


class FuelConfig(Section, frozen=True, kw_only=True):
    """Fuel of one jet: idle_kg_s + kg_n_s T."""

    idle_kg_s: NonNegative
    kg_n_s: NonNegative
