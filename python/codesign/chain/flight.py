"""From a study's [flight] and [trajectories] sections to the native FlightSettings: names and units, no physics."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Mapping
from pathlib import Path

import msgspec
import numpy as np

from codesign import dynamics as dyn
from codesign.chain.predictive import pulses, set_predictive, standardized_turbine, waypoint_path
from codesign.errors import CodesignError, StudyError
from codesign.names import nearest
from codesign.study.config import StudyConfig
from codesign.study.controller.checks import JET_MODELS, NEEDED
from codesign.study.flight_config import (
    CommandSpeedsConfig,
    DisturbancesConfig,
    FlightConfig,
    GainsConfig,
    LimitsConfig,
    ReferencesConfig,
    TrajectoryConfig,
    WeightsConfig,
)
from codesign.transforms import pose
from codesign.units import DEGREE

PER_AXIS = ("wind_n", "wind_m_s", "gust_deviation_n")  # disturbances with a value for each axis
TURBINE_COEFFICIENTS = ("K_T", "K_TT", "K_D", "K_DD", "K_TD", "B_U", "B_T", "B_D", "B_UU", "c")


@contextlib.contextmanager
def refusals(study: Path) -> Iterator[None]:
    """Turns what the native code refuses of a study's values, as a last resort, into a StudyError that names it."""
    try:
        yield
    except CodesignError:
        raise
    except ValueError as error:
        raise StudyError(f"{study}: {error}") from error


def joint_names(flight: FlightConfig) -> list[str]:
    """Actuated joints in the order of all joint vectors: group by group."""
    return [joint for group in flight.joint_groups for joint in group.joints]


def find_trajectory(config: StudyConfig, name: str) -> TrajectoryConfig:
    """A trajectory of the study; `name@seed`: with its disturbances drawn from another seed.

    `name@seed:key=value,…` (see `disturbed`) sets sizes of the disturbances, too.
    Raises: StudyError if there is none of that name, or seed or sizes are none.
    """
    base, at, drawn = name.partition("@")
    if base not in config.trajectories:
        raise StudyError(f"no trajectory {base!r}; {nearest(base, config.trajectories)}")
    trajectory = config.trajectories[base]
    if not at:
        return trajectory
    seed, _, sizes = drawn.partition(":")
    if not seed.isdecimal():
        raise StudyError(f"trajectory {name!r}: the seed after @ must be a whole number")
    values = msgspec.to_builtins(trajectory.disturbances) | {"seed": int(seed)}
    try:
        for key, value in (size.split("=") for size in sizes.split(",") if size):
            values[key] = [float(value)] * 3 if key in PER_AXIS else float(value)
        disturbances = msgspec.convert(values, DisturbancesConfig)
    except ValueError as error:
        raise StudyError(f"trajectory {name!r}: {error}") from error
    return msgspec.structs.replace(trajectory, disturbances=disturbances)


def disturbed(trajectory: str, seed: int, sizes: Mapping[str, float]) -> str:
    """Name of a trajectory flown with disturbances of the given sizes, drawn from a seed.

    sizes: by key of `[trajectories.<name>.disturbances]`; a gust's deviation or a wind is the same along all axes.
    """
    return f"{trajectory}@{seed}:" + ",".join(f"{key}={float(value)!r}" for key, value in sizes.items())


def flight_settings(
    flight: FlightConfig, trajectory: TrajectoryConfig, jet_model: str | None = None
) -> dyn.FlightSettings:
    """Native settings of one flight on one trajectory, SI units; `jet_model`: instead of the study's.

    Raises: StudyError if there is no such jet model.
    """
    settings = dyn.FlightSettings()
    _set_rates(settings, flight)
    settings.duration = flight_duration(flight, trajectory)
    settings.joints = joint_names(flight)
    settings.actuators = actuators(flight, jet_model or flight.jet_model)
    _set_initial_state(settings, flight)
    _set_plant(settings, flight)
    if flight.controller == "mpc":
        if flight.mpc is None or flight.servo is None:
            raise StudyError("controller 'mpc' needs the sections [flight.mpc] and [flight.servo]")
        set_predictive(settings, flight, flight.mpc, flight.servo)
    else:
        _set_momentum_qp(settings, flight)
    _set_groups(settings, flight)
    settings.path = waypoint_path(trajectory)
    settings.pulses = pulses(trajectory)
    if flight.fuel is not None:
        settings.fuel = dyn.FuelRate(idle=flight.fuel.idle_kg_s, per_newton=flight.fuel.kg_n_s)
    settings.trajectory = [
        dyn.CommandWindow(
            start=w.from_s, end=w.to_s, front=w.forward, left=w.left, up=w.up, roll=w.roll, pitch=w.pitch, yaw=w.yaw
        )
        for w in trajectory.windows
    ]
    settings.disturbances = _disturbances(trajectory.disturbances)
    settings.contact_points = [
        dyn.ContactPoint(frame=frame, position=np.array(point))
        for frame in flight.ground.frames
        for point in flight.ground.points_m
    ]
    settings.ground_height = flight.ground.height_m
    settings.failure = dyn.FailureLimits(
        com_error=flight.failure.com_error_m,
        attitude_error=flight.failure.attitude_error_deg * DEGREE,
        joint_speed=flight.failure.joint_speed_rad_s,
    )
    return settings


def flight_duration(flight: FlightConfig, trajectory: TrajectoryConfig) -> float:
    """Of a flight on a trajectory [s]."""
    return trajectory.duration_s or flight.duration_s


def _disturbances(disturbances: DisturbancesConfig) -> dyn.Disturbances:
    return dyn.Disturbances(
        wind_force=np.array(disturbances.wind_n),
        wind_velocity=np.array(disturbances.wind_m_s),
        gust_deviation=np.array(disturbances.gust_deviation_n),
        gust_time=disturbances.gust_time_s,
        mass_scale=disturbances.mass_scale,
        mass_deviation=disturbances.mass_deviation,
        thrust_deviation=disturbances.thrust_deviation,
        seed=disturbances.seed,
    )


def flight_seeds(config: StudyConfig, trajectory: str) -> list[int]:
    """Seeds of the flights on a trajectory: the study's, or the one of `name@seed` or of a calm trajectory."""
    flown = find_trajectory(config, trajectory)
    return (
        list(config.flown.seeds) if _is_drawn(trajectory, flown) and config.flown.seeds else [flown.disturbances.seed]
    )


def _is_drawn(trajectory: str, flown: TrajectoryConfig) -> bool:
    sizes = flown.disturbances
    return "@" not in trajectory and any([*sizes.gust_deviation_n, sizes.mass_deviation, sizes.thrust_deviation])


def _per_joint(flight: FlightConfig, attribute: str) -> np.ndarray:
    """(joints,) of what each group gives for all its joints or for each; (0,) where a list is left out."""
    values = [
        np.broadcast_to(value, len(group.joints))
        for group in flight.joint_groups
        if (value := getattr(group, attribute)) != []
    ]
    return np.concatenate(values).astype(float) if values else np.zeros(0)


def _none_if_zero(values: np.ndarray) -> np.ndarray:
    return values if values.any() else np.zeros(0)


def _set_rates(settings: dyn.FlightSettings, flight: FlightConfig) -> None:
    torque_step = flight.torque_step_s or flight.step_s
    settings.step = flight.step_s
    settings.torque_updates = round(flight.step_s / torque_step)
    settings.hold_inertia = flight.hold_inertia
    settings.substeps = round(torque_step / (flight.plant_step_s or torque_step))
    settings.integrator = getattr(dyn.Integrator, flight.integrator)


def _set_plant(settings: dyn.FlightSettings, flight: FlightConfig) -> None:
    settings.rotor_inertia = _none_if_zero(_per_joint(flight, "rotor_inertia_kg_m2"))
    settings.friction = dyn.Friction(
        viscous=_none_if_zero(_per_joint(flight, "viscous_friction_n_m_per_rad_s")),
        coulomb=_none_if_zero(_per_joint(flight, "coulomb_friction_n_m")),
        slip_speed=flight.drives.slip_speed_rad_s,
    )
    settings.delays = dyn.Delays(
        momentum=flight.drives.momentum_delay_s,
        torque=flight.drives.torque_delay_s,
        torque_lag=flight.drives.torque_lag_s,
    )
    if drag := flight.drag:
        areas = np.broadcast_to(drag.areas_m2, len(drag.frames))
        positions = drag.positions_m or [(0.0, 0.0, 0.0)] * len(drag.frames)
        settings.drag = [
            dyn.DragArea(frame=frame, position=np.array(position), area=float(area))
            for frame, position, area in zip(drag.frames, positions, areas, strict=True)
        ]
        settings.air_density = drag.air_density_kg_m3
    if tank := flight.tank:
        settings.tank = dyn.Tank(
            frame=tank.frame,
            position=np.array(tank.position_m),
            fuel=tank.fuel_kg,
            consumption=tank.consumption_kg_per_n_s,
        )


def _set_initial_state(settings: dyn.FlightSettings, flight: FlightConfig) -> None:
    initial = flight.initial_state
    settings.base_pose = pose(initial.base_position_m, [angle * DEGREE for angle in initial.base_rpy_deg])
    settings.initial_joints = np.array([angle for group in flight.joint_groups for angle in group.initial_rad])
    settings.initial_thrusts = np.broadcast_to(initial.thrust_n, len(flight.jets.frames))
    settings.initial_free_fall = initial.free_fall_first_step
    settings.posture_reference = _per_joint(flight, "reference_rad")
    if trim := initial.trim:
        settings.trim = dyn.TrimSettings(
            joints=trim.joints, tilt_weight=trim.tilt_weight, thrust_weight=trim.thrust_weight
        )


def actuators(flight: FlightConfig, jet_model: str) -> list[dyn.Actuator]:
    """What pushes the robot, in the order of the jets' frames. Raises: StudyError: no such jet model."""
    jets = flight.jets
    count = len(jets.frames)
    axes = np.broadcast_to(np.array(jets.axes or [(0.0, 0.0, -1.0)]), (count, 3))
    per_jet = {
        "reaction": np.multiply(jets.reaction_n_m_per_n, jets.senses or 1),
        "thrust_min": jets.min_thrust_n,
        "thrust_max": jets.max_thrust_n,
        "thrust_rate": jets.max_thrust_rate_n_s,
    }
    numbers = {name: np.broadcast_to(value, count) for name, value in per_jet.items()}
    dynamics = _thrust_dynamics(flight, jet_model)
    return [
        dyn.Actuator(
            frame=frame,
            axis=axes[i] / np.linalg.norm(axes[i]),
            dynamics=dynamics[i],
            **{name: float(v[i]) for name, v in numbers.items()},
        )
        for i, frame in enumerate(jets.frames)
    ]


def _thrust_dynamics(
    flight: FlightConfig, jet_model: str
) -> list[dyn.RateIntegrator | dyn.FirstOrderLag | dyn.Turbine | dyn.StandardizedTurbine]:
    count = len(flight.jets.frames)
    if jet_model == "integrator":
        return [dyn.RateIntegrator()] * count
    if jet_model == "lag":
        return [dyn.FirstOrderLag(time=float(time)) for time in np.broadcast_to(flight.jets.lag_s, count)]
    if jet_model in flight.jet_models:
        return [standardized_turbine(flight.jet_models[jet_model])] * count
    if jet_model != "turbine":
        raise StudyError(f"no jet model {jet_model!r}; {nearest(jet_model, [*JET_MODELS, *flight.jet_models])}")
    if flight.turbine is None:
        raise StudyError("jet model 'turbine' needs the section [flight.turbine]")
    coefficients = {key: getattr(flight.turbine, key) for key in TURBINE_COEFFICIENTS}
    turbine = dyn.Turbine(
        **coefficients,
        throttle_max=flight.turbine.max_throttle_percent,
        rate_gain=flight.turbine.throttle_gain,
    )
    return [turbine] * count


def _set_momentum_qp(settings: dyn.FlightSettings, flight: FlightConfig) -> None:
    sections = (flight.command_speeds, flight.references, flight.gains, flight.weights, flight.limits)
    speeds, references, gains, weights, limits = sections
    if speeds is None or references is None or gains is None or weights is None or limits is None:
        raise StudyError(f"controller 'momentum_qp' needs the sections {', '.join(NEEDED['momentum_qp'])} of [flight]")
    _set_references(settings, speeds, references)
    _set_controller(settings, flight, gains, weights, limits)


def _set_references(settings: dyn.FlightSettings, speeds: CommandSpeedsConfig, references: ReferencesConfig) -> None:
    settings.command_speeds = dyn.CommandSpeeds(
        front=speeds.forward_m_s,
        left=speeds.lateral_m_s,
        up=speeds.vertical_m_s,
        roll=speeds.roll_deg_s * DEGREE,
        pitch=speeds.pitch_deg_s * DEGREE,
        yaw=speeds.yaw_deg_s * DEGREE,
    )
    settings.reference = dyn.ReferenceSettings(
        roll_min=references.roll_range_deg[0] * DEGREE,
        roll_max=references.roll_range_deg[1] * DEGREE,
        pitch_min=references.pitch_range_deg[0] * DEGREE,
        pitch_max=references.pitch_range_deg[1] * DEGREE,
        com_time=references.position_smoothing_s,
        jerk_time=references.jerk_smoothing_s,
        rotation_gain=references.rotation_gain_hz,
        angular_velocity_time=references.angular_velocity_smoothing_s,
    )


def _set_controller(
    settings: dyn.FlightSettings,
    flight: FlightConfig,
    gains: GainsConfig,
    weights: WeightsConfig,
    limits: LimitsConfig,
) -> None:
    settings.gains = dyn.Gains(
        momentum_proportional=gains.linear_proportional,
        momentum_derivative=gains.linear_derivative,
        momentum_integral=gains.linear_momentum,
        attitude_proportional=gains.attitude_proportional,
        attitude_derivative=gains.attitude_derivative,
        posture=_per_joint(flight, "posture_gain_hz"),
        torque_proportional=gains.joint_proportional,
        torque_integral=gains.joint_integral,
        observer=gains.observer_hz,
    )
    settings.weights = dyn.Weights(
        momentum=weights.momentum,
        constant_inertia=weights.constant_inertia,
        posture=weights.posture,
        joint_velocity=weights.joint_velocity,
        thrust_rate=weights.thrust_rate,
        thrust_symmetry=weights.thrust_symmetry,
        regularization=weights.regularization,
        torque=weights.torque,
    )
    ranges = np.array([r for group in flight.joint_groups for r in group.ranges_deg]).reshape(-1, 2) * DEGREE
    settings.limits = dyn.Limits(
        joint_lower=ranges[:, 0],
        joint_upper=ranges[:, 1],
        joint_range_scale=_per_joint(flight, "range_scale"),
        joint_speed=limits.joint_speed_deg_s * DEGREE,
        joint_slope=limits.joint_speed_slope_per_rad,
        thrust_slope=limits.thrust_rate_slope_per_n,
        torque=limits.torque_n_m,
        torque_rate=limits.torque_rate_n_m_s,
    )
    jets = flight.jets.frames
    settings.symmetry_pairs = [(jets.index(a), jets.index(b)) for a, b in flight.jets.symmetric_pairs]


def _set_groups(settings: dyn.FlightSettings, flight: FlightConfig) -> None:
    settings.groups = [
        dyn.JointGroup(name=group.name, joints=group.joints, weight=group.velocity_weight)
        for group in flight.joint_groups
        if group.velocity_weight > 0
    ]
