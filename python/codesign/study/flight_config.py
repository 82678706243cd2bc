"""The section [flight] of study.toml and the trajectories."""

from __future__ import annotations

from typing import Literal

from codesign.study.controller.config import FuelConfig, MpcConfig, ServoConfig, StandardizedJetConfig
from codesign.study.sections import Deviation, Name, NonNegative, Positive, Range, Section, Seed, Sign, Vector3


class TrimConfig(Section, frozen=True, kw_only=True):
    """Start in a hover: of all states in which the thrusts carry the weight, the one nearest to the initial state.

    Nearest: least Σ (Δs)² + (tilt_weight · tilt)² + Σ (thrust_weight (T - mean))², [rad], [N].
    """

    joints: list[str]
    tilt_weight: Positive = 3.0
    thrust_weight: Positive = 0.003


class InitialStateConfig(Section, frozen=True, kw_only=True):
    """State at the start of a flight."""

    base_position_m: Vector3
    base_rpy_deg: Vector3 = (0.0, 0.0, 0.0)
    thrust_n: NonNegative | list[NonNegative]
    free_fall_first_step: bool = False
    trim: TrimConfig | None = None


class JointGroupConfig(Section, frozen=True, kw_only=True):
    """Joints that share controller settings; each list has one value per joint."""

    name: Name
    joints: list[str]
    initial_rad: list[float]
    reference_rad: list[float] = []
    ranges_deg: list[Range] = []
    range_scale: Positive = 1.0
    posture_gain_hz: NonNegative | None = None
    velocity_weight: NonNegative = 0.0
    rotor_inertia_kg_m2: NonNegative | list[NonNegative] = 0.0
    viscous_friction_n_m_per_rad_s: NonNegative | list[NonNegative] = 0.0
    coulomb_friction_n_m: NonNegative | list[NonNegative] = 0.0


class JetsConfig(Section, frozen=True, kw_only=True):
    """What pushes the robot: jets, propellers. Numbers are of all, or a list with one for each.

    frames: where they sit. axes: unit vectors in the frames that the thrusts push along; empty: minus z of each.
    reaction_n_m_per_n: moment about the axis per newton of thrust, the drag torque of a propeller; positive where it
    turns the robot counter-clockwise about the axis. senses: 1 or -1 for each of frames, by which the reaction is
    multiplied: one number then does for propellers that turn in turn. symmetric_pairs: frames whose thrust rates should
    agree. lag_s: time constant of the jet model "lag".
    """

    frames: list[str]
    max_thrust_n: Positive | list[Positive]
    max_thrust_rate_n_s: Positive | list[Positive]
    min_thrust_n: NonNegative | list[NonNegative] = 0.0
    axes: list[Vector3] = []
    reaction_n_m_per_n: float | list[float] = 0.0
    senses: list[Sign] = []
    lag_s: Positive | list[Positive] = 0.05
    symmetric_pairs: list[tuple[str, str]] = []

    @property
    def kind(self) -> str:
        """What they are called: propellers have a drag torque, jets none."""
        reactions = self.reaction_n_m_per_n
        return "propeller" if any(reactions if isinstance(reactions, list) else [reactions]) else "jet"


class CommandSpeedsConfig(Section, frozen=True, kw_only=True):
    """Rates of the reference for a full-scale command."""

    forward_m_s: Positive
    vertical_m_s: Positive
    lateral_m_s: Positive
    roll_deg_s: Positive
    pitch_deg_s: Positive
    yaw_deg_s: Positive


class ReferencesConfig(Section, frozen=True, kw_only=True):
    """From commands to smooth references."""

    roll_range_deg: Range
    pitch_range_deg: Range
    position_smoothing_s: Positive
    jerk_smoothing_s: Positive
    rotation_gain_hz: Positive
    angular_velocity_smoothing_s: Positive


class GainsConfig(Section, frozen=True, kw_only=True):
    """Controller gains; docs/control.md gives the control law, `codesign tune` proposes them."""

    linear_proportional: NonNegative
    linear_derivative: NonNegative
    linear_momentum: Positive
    attitude_proportional: NonNegative
    attitude_derivative: NonNegative
    joint_integral: NonNegative
    joint_proportional: NonNegative
    observer_hz: NonNegative = 0.0


class WeightsConfig(Section, frozen=True, kw_only=True):
    """Weights of the momentum and the torque QP."""

    momentum: NonNegative
    constant_inertia: NonNegative
    posture: NonNegative
    joint_velocity: NonNegative
    thrust_rate: NonNegative
    thrust_symmetry: NonNegative
    regularization: Positive
    torque: Positive


class LimitsConfig(Section, frozen=True, kw_only=True):
    """Bounds of both QPs."""

    joint_speed_deg_s: Positive
    joint_speed_slope_per_rad: Positive
    thrust_rate_slope_per_n: Positive
    torque_n_m: Positive
    torque_rate_n_m_s: Positive


class DrivesConfig(Section, frozen=True, kw_only=True):
    """How late and how rough the drives are; all of it unknown to the controller."""

    momentum_delay_s: NonNegative = 0.0
    torque_delay_s: NonNegative = 0.0
    torque_lag_s: NonNegative = 0.0
    slip_speed_rad_s: Positive = 0.02


class DragConfig(Section, frozen=True, kw_only=True):
    """What air drags, a point each: force ½ ρ C_d A u² against the velocity u through the air."""

    frames: list[str]
    areas_m2: NonNegative | list[NonNegative]
    positions_m: list[Vector3] = []
    air_density_kg_m3: Positive = 1.225


class TankConfig(Section, frozen=True, kw_only=True):
    """Fuel on board, part of its link's inertia at the start; the controller does not see it go."""

    frame: str
    position_m: Vector3 = (0.0, 0.0, 0.0)
    fuel_kg: Positive
    consumption_kg_per_n_s: NonNegative


class FailureConfig(Section, frozen=True, kw_only=True):
    """Limits; exceeding one ends the flight as lost."""

    com_error_m: Positive
    attitude_error_deg: Positive
    joint_speed_rad_s: Positive


class GroundConfig(Section, frozen=True, kw_only=True):
    """Points of the robot monitored for ground contact."""

    height_m: float = 0.0
    frames: list[str] = []
    points_m: list[Vector3] = []


class TurbineConfig(Section, frozen=True, kw_only=True):
    """Coefficients of the second-order thrust model and of its throttle controller."""

    K_T: float
    K_TT: float
    K_D: float
    K_DD: float
    K_TD: float
    B_U: float
    B_T: float
    B_D: float
    B_UU: float
    c: float
    throttle_gain: Positive
    max_throttle_percent: Positive


class FlightConfig(Section, frozen=True, kw_only=True):
    """Plant, jets, controller and reference generator.

    controller: "momentum_qp" needs command_speeds, references, gains, weights and limits, and of every joint its range
    and posture gain; "mpc" needs mpc and servo, and a jet model of jet_models. jet_model: "integrator", "lag",
    "turbine", or a name of jet_models.
    """

    trajectory: str
    step_s: Positive
    torque_step_s: Positive | None = None
    plant_step_s: Positive | None = None
    hold_inertia: bool = False
    integrator: Literal["euler", "semi_implicit_euler", "runge_kutta_4"] = "euler"
    duration_s: Positive
    seeds: list[Seed] = []
    controller: Literal["momentum_qp", "mpc"] = "momentum_qp"
    jet_model: Name = "integrator"
    jet_models: dict[Name, StandardizedJetConfig] = {}
    mpc: MpcConfig | None = None
    servo: ServoConfig | None = None
    fuel: FuelConfig | None = None
    initial_state: InitialStateConfig
    joint_groups: list[JointGroupConfig] = []
    jets: JetsConfig
    command_speeds: CommandSpeedsConfig | None = None
    references: ReferencesConfig | None = None
    gains: GainsConfig | None = None
    weights: WeightsConfig | None = None
    limits: LimitsConfig | None = None
    drives: DrivesConfig = DrivesConfig()
    drag: DragConfig | None = None
    tank: TankConfig | None = None
    failure: FailureConfig
    ground: GroundConfig = GroundConfig()
    turbine: TurbineConfig | None = None


class WindowConfig(Section, frozen=True, kw_only=True):
    """A command that acts at samples strictly between two times: signs of the command speeds."""

    from_s: NonNegative
    to_s: Positive
    forward: Sign = 0.0
    left: Sign = 0.0
    up: Sign = 0.0
    roll: Sign = 0.0
    pitch: Sign = 0.0
    yaw: Sign = 0.0


class DisturbancesConfig(Section, frozen=True, kw_only=True):
    """What the flight has and the controller does not know; deviations are drawn from the seed."""

    wind_n: Vector3 = (0.0, 0.0, 0.0)
    wind_m_s: Vector3 = (0.0, 0.0, 0.0)
    gust_deviation_n: tuple[NonNegative, NonNegative, NonNegative] = (0.0, 0.0, 0.0)
    gust_time_s: Positive = 1.0
    mass_scale: Positive = 1.0
    mass_deviation: Deviation = 0.0
    thrust_deviation: Deviation = 0.0
    seed: Seed = 0


class WaypointConfig(Section, frozen=True, kw_only=True):
    """A point of a path, relative to its start, world axes; duration_s: to get there; rest_s: there."""

    m: Vector3
    yaw_deg: float = 0.0
    duration_s: Positive
    rest_s: NonNegative = 0.0


class PulseConfig(Section, frozen=True, kw_only=True):
    """A force on the base through the center of mass and a moment on the base, world axes, for a time."""

    at_s: NonNegative
    for_s: Positive
    force_n: Vector3 = (0.0, 0.0, 0.0)
    moment_n_m: Vector3 = (0.0, 0.0, 0.0)


class TrajectoryConfig(Section, frozen=True, kw_only=True):
    """Piloted segments, or way-points; hover outside of them; calm unless disturbed.

    kind: "stop", at rest in every way-point on minimum-jerk legs; "through", least squared jerk through all of them, at
    rest at both ends and where rest_s says so. rest_s: before the first leg. duration_s: of the flight; default: that
    of [flight].
    """

    windows: list[WindowConfig] = []
    waypoints: list[WaypointConfig] = []
    kind: Literal["stop", "through"] = "stop"
    rest_s: NonNegative = 0.0
    duration_s: Positive | None = None
    pulses: list[PulseConfig] = []
    label: str = ""
    disturbances: DisturbancesConfig = DisturbancesConfig()
