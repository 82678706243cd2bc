"""
Rigid-body dynamics, box QP and flight.
"""

from __future__ import annotations
import collections.abc
import numpy
import numpy.typing
import typing

__all__: list[str] = [
    "Actuator",
    "BoxQpResult",
    "BoxQpSolver",
    "CommandSpeeds",
    "CommandWindow",
    "ContactPoint",
    "Controller",
    "Delays",
    "Disturbances",
    "DragArea",
    "FailureLimits",
    "FirstOrderLag",
    "FlightLog",
    "FlightMeasures",
    "FlightObjectives",
    "FlightProfile",
    "FlightSettings",
    "FlightStatus",
    "Friction",
    "FuelRate",
    "Gains",
    "Integrator",
    "JetPrediction",
    "JointGroup",
    "Limits",
    "MAX_URDF_BYTES",
    "Model",
    "ObjectiveParts",
    "Path",
    "PathPoint",
    "PlantInputs",
    "PredictionModel",
    "PredictionState",
    "PredictiveController",
    "PredictiveIntegral",
    "PredictiveModelOptions",
    "PredictiveSettings",
    "PredictiveWeights",
    "Pulse",
    "QpStatus",
    "RateIntegrator",
    "ReferenceSettings",
    "RobotState",
    "ServoIntegrator",
    "ServoPlantSettings",
    "ServoSettings",
    "StandardizedTurbine",
    "Tank",
    "Trim",
    "TrimSettings",
    "Turbine",
    "Waypoint",
    "WaypointKind",
    "WaypointPath",
    "Weights",
    "bias_forces",
    "center_of_mass",
    "center_of_mass_jacobian",
    "center_of_mass_velocity",
    "centroidal_momentum",
    "centroidal_momentum_bias",
    "centroidal_momentum_matrix",
    "check_inertia",
    "check_urdf",
    "fitted_settings",
    "forward_dynamics",
    "frame_bias_acceleration",
    "frame_jacobian",
    "frame_pose",
    "frame_velocity",
    "gravity_forces",
    "hull_distances",
    "inverse_dynamics",
    "kinetic_energy",
    "load_urdf",
    "locked_inertia",
    "mass_matrix",
    "momentum_qps",
    "nearest_approaches",
    "potential_energy",
    "simulate_flight",
    "simulate_flights",
    "solve_box_qp",
    "trim_hover",
]

class Model:
    """
    A robot, made by load_urdf: joints that move, links as frames, masses.
    """
    def __repr__(self) -> str: ...
    @property
    def base_link(self) -> str:
        """
        Name of the root link, whose pose is base_pose.
        """
    @property
    def dofs(self) -> int:
        """
        Length of nu: 6 + n, or n if fixed_base.
        """
    @property
    def fixed_base(self) -> bool:
        """
        Whether the root link is held.
        """
    @property
    def frame_names(self) -> list[str]:
        """
        Names of all links, fixed and locked ones included, in the order of the URDF.
        """
    @property
    def joint_limits(self) -> dict:
        """
        Name to lower, upper [rad, m], velocity and effort, as in the URDF. For information: no function applies them.
        """
    @property
    def joint_names(self) -> list[str]:
        """
        Names of the joints that move, in the order of s and of the joint part of nu.
        """
    @property
    def name(self) -> str:
        """
        Name of the robot.
        """
    @property
    def total_mass(self) -> float:
        """
        Mass of all links [kg].
        """

class Controller:
    """
    What flies the robot.

    Members:

      momentum_qp : momentum and torque QPs

      predictive : multi-rate predictive control, servos
    """

    __members__: typing.ClassVar[dict[str, Controller]]
    momentum_qp: typing.ClassVar[Controller]
    predictive: typing.ClassVar[Controller]
    @typing.overload
    def __eq__(self, other: Controller) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: Controller) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class WaypointKind:
    """
    How a path goes through its way-points.

    Members:

      stop : at rest in each: minimum-jerk legs

      through : least squared jerk, at rest at both ends
    """

    __members__: typing.ClassVar[dict[str, WaypointKind]]
    stop: typing.ClassVar[WaypointKind]
    through: typing.ClassVar[WaypointKind]
    @typing.overload
    def __eq__(self, other: WaypointKind) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: WaypointKind) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class Waypoint:
    """
    A point of a path, relative to its start.
    """
    def __copy__(self) -> Waypoint: ...
    def __deepcopy__(self, arg0: dict) -> Waypoint: ...
    def __getstate__(self) -> dict: ...
    def __init__(self, **kwargs) -> None: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def duration(self) -> float:
        """
        to get there [s]
        """
    @duration.setter
    def duration(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def position(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) world axes [m]
        """
    @position.setter
    def position(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def rest(self) -> float:
        """
        there [s]
        """
    @rest.setter
    def rest(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def yaw(self) -> float:
        """
        [rad]
        """
    @yaw.setter
    def yaw(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class WaypointPath:
    """
    A path through way-points.
    """
    def __copy__(self) -> WaypointPath: ...
    def __deepcopy__(self, arg0: dict) -> WaypointPath: ...
    def __getstate__(self) -> dict: ...
    def __init__(self, **kwargs) -> None: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def kind(self) -> WaypointKind:
        """
        WaypointKind
        """
    @kind.setter
    def kind(self, arg0: WaypointKind) -> None: ...
    @property
    def start(self) -> float:
        """
        time at the start position [s]
        """
    @start.setter
    def start(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def waypoints(self) -> list[Waypoint]:
        """
        list of Waypoint
        """
    @waypoints.setter
    def waypoints(self, arg0: collections.abc.Sequence[Waypoint]) -> None: ...

class PathPoint:
    """
    Position (x, y, z) and yaw of a path, derivatives.
    """
    @property
    def acceleration(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[4, 1]"]:
        """
        (4,) [m/s^2, rad/s^2]
        """
    @property
    def jerk(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[4, 1]"]:
        """
        (4,) [m/s^3, rad/s^3]
        """
    @property
    def value(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[4, 1]"]:
        """
        (4,) [m, rad]
        """
    @property
    def velocity(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[4, 1]"]:
        """
        (4,) [m/s, rad/s]
        """

class Path:
    """
    A path as functions of time; after its end it holds.
    """
    def __init__(self, path: WaypointPath) -> None: ...
    def at(self, time: typing.SupportsFloat | typing.SupportsIndex) -> PathPoint:
        """
        PathPoint at a time [s].
        """
    @property
    def end(self) -> float:
        """
        [s]
        """
    @property
    def peak_acceleration(self) -> float:
        """
        [m/s^2]
        """
    @property
    def peak_speed(self) -> float:
        """
        [m/s]
        """

class Pulse:
    """
    Force on the base through the center of mass, and moment on the base.
    """
    def __copy__(self) -> Pulse: ...
    def __deepcopy__(self, arg0: dict) -> Pulse: ...
    def __getstate__(self) -> dict: ...
    def __init__(self, **kwargs) -> None: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def duration(self) -> float:
        """
        [s]
        """
    @duration.setter
    def duration(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def force(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) world axes [N]
        """
    @force.setter
    def force(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def moment(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) world axes [N m]
        """
    @moment.setter
    def moment(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def start(self) -> float:
        """
        [s]
        """
    @start.setter
    def start(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class StandardizedTurbine:
    """
    Second-order jet identified in standardized variables T, D, U: T'' = thrust_scale (f + g v), v = U + B_UU U^2, f = c + K_T T + K_D D + K_TD T D + K_TT T^2 + K_DD D^2, g = B + B_T T + B_D D + B_TD T D + B_TT T^2 + B_DD D^2.
    """
    def __copy__(self) -> StandardizedTurbine: ...
    def __deepcopy__(self, arg0: dict) -> StandardizedTurbine: ...
    def __getstate__(self) -> dict: ...
    def __init__(self, **kwargs) -> None: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    def steady_variable(self, thrust: typing.SupportsFloat | typing.SupportsIndex) -> float:
        """
        v that holds a thrust [N]
        """
    def throttle(self, variable: typing.SupportsFloat | typing.SupportsIndex) -> float:
        """
        [%] of v, within its range
        """
    def variable(self, throttle: typing.SupportsFloat | typing.SupportsIndex) -> float:
        """
        v of a throttle [%]
        """
    @property
    def B(self) -> float: ...
    @B.setter
    def B(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def B_D(self) -> float: ...
    @B_D.setter
    def B_D(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def B_DD(self) -> float: ...
    @B_DD.setter
    def B_DD(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def B_T(self) -> float: ...
    @B_T.setter
    def B_T(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def B_TD(self) -> float: ...
    @B_TD.setter
    def B_TD(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def B_TT(self) -> float: ...
    @B_TT.setter
    def B_TT(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def B_UU(self) -> float: ...
    @B_UU.setter
    def B_UU(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def K_D(self) -> float: ...
    @K_D.setter
    def K_D(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def K_DD(self) -> float: ...
    @K_DD.setter
    def K_DD(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def K_T(self) -> float: ...
    @K_T.setter
    def K_T(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def K_TD(self) -> float: ...
    @K_TD.setter
    def K_TD(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def K_TT(self) -> float: ...
    @K_TT.setter
    def K_TT(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def c(self) -> float: ...
    @c.setter
    def c(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def rate_gain(self) -> float:
        """
        of a loop that follows a thrust rate [1/s]
        """
    @rate_gain.setter
    def rate_gain(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def throttle_max(self) -> float:
        """
        [%]
        """
    @throttle_max.setter
    def throttle_max(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def throttle_mean(self) -> float:
        """
        [%]
        """
    @throttle_mean.setter
    def throttle_mean(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def throttle_scale(self) -> float:
        """
        [%]
        """
    @throttle_scale.setter
    def throttle_scale(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def thrust_mean(self) -> float:
        """
        [N]
        """
    @thrust_mean.setter
    def thrust_mean(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def thrust_scale(self) -> float:
        """
        [N]
        """
    @thrust_scale.setter
    def thrust_scale(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class PredictiveWeights:
    """
    Weights of the prediction's cost.
    """
    def __copy__(self) -> PredictiveWeights: ...
    def __deepcopy__(self, arg0: dict) -> PredictiveWeights: ...
    def __getstate__(self) -> dict: ...
    def __init__(self, **kwargs) -> None: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def angular_momentum(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) axes of the body
        """
    @angular_momentum.setter
    def angular_momentum(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def attitude(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) roll, pitch, yaw
        """
    @attitude.setter
    def attitude(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def attitude_integral(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,)
        """
    @attitude_integral.setter
    def attitude_integral(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def com(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,)
        """
    @com.setter
    def com(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def com_integral(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,)
        """
    @com_integral.setter
    def com_integral(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def joint_displacement(self) -> float:
        """
        [1/rad^2]
        """
    @joint_displacement.setter
    def joint_displacement(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def linear_momentum(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) axes of the body
        """
    @linear_momentum.setter
    def linear_momentum(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def posture(self) -> float:
        """
        [1/rad^2]
        """
    @posture.setter
    def posture(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def throttle_change(self) -> float:
        """
        between blocks
        """
    @throttle_change.setter
    def throttle_change(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def throttle_first(self) -> float:
        """
        of the first block from the throttle that acts
        """
    @throttle_first.setter
    def throttle_first(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class PredictiveIntegral:
    """
    Where integrals of errors start.

    Members:

      restart : at the present error, as published

      accumulate : at the sum of all errors so far
    """

    __members__: typing.ClassVar[dict[str, PredictiveIntegral]]
    accumulate: typing.ClassVar[PredictiveIntegral]
    restart: typing.ClassVar[PredictiveIntegral]
    @typing.overload
    def __eq__(self, other: PredictiveIntegral) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: PredictiveIntegral) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class PredictiveModelOptions:
    """
    What the prediction knows.
    """
    def __copy__(self) -> PredictiveModelOptions: ...
    def __deepcopy__(self, arg0: dict) -> PredictiveModelOptions: ...
    def __getstate__(self) -> dict: ...
    def __init__(self, **kwargs) -> None: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def gravity_coupling(self) -> bool:
        """
        gravity turns with the predicted attitude; published: False
        """
    @gravity_coupling.setter
    def gravity_coupling(self, arg0: bool) -> None: ...
    @property
    def jet_dynamics(self) -> bool:
        """
        False: thrust follows the throttle at once
        """
    @jet_dynamics.setter
    def jet_dynamics(self, arg0: bool) -> None: ...
    @property
    def varying(self) -> bool:
        """
        False: the linearization of the first solve is kept
        """
    @varying.setter
    def varying(self, arg0: bool) -> None: ...

class PredictiveSettings:
    """
    Multi-rate predictive control.
    """
    def __copy__(self) -> PredictiveSettings: ...
    def __deepcopy__(self, arg0: dict) -> PredictiveSettings: ...
    def __getstate__(self) -> dict: ...
    def __init__(self, **kwargs) -> None: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def body(self) -> str:
        """
        link whose attitude is controlled
        """
    @body.setter
    def body(self, arg0: str) -> None: ...
    @property
    def control_steps(self) -> int:
        """
        steps with joint inputs of their own
        """
    @control_steps.setter
    def control_steps(self, arg0: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def integral(self) -> PredictiveIntegral:
        """
        PredictiveIntegral
        """
    @integral.setter
    def integral(self, arg0: PredictiveIntegral) -> None: ...
    @property
    def joint_speed(self) -> float:
        """
        largest [rad/s]; infinity: no bound
        """
    @joint_speed.setter
    def joint_speed(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def joints(self) -> list[str]:
        """
        names of the joints that are moved
        """
    @joints.setter
    def joints(self, arg0: collections.abc.Sequence[str]) -> None: ...
    @property
    def large_step(self) -> float:
        """
        [s]
        """
    @large_step.setter
    def large_step(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def large_steps(self) -> int:
        """
        how many follow
        """
    @large_steps.setter
    def large_steps(self, arg0: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def model(self) -> PredictiveModelOptions:
        """
        PredictiveModelOptions
        """
    @model.setter
    def model(self, arg0: PredictiveModelOptions) -> None: ...
    @property
    def period(self) -> float:
        """
        of solves and joint set points [s]
        """
    @period.setter
    def period(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def small_steps(self) -> int:
        """
        adding up to large_step
        """
    @small_steps.setter
    def small_steps(self, arg0: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def throttle_every(self) -> int:
        """
        solves
        """
    @throttle_every.setter
    def throttle_every(self, arg0: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def weights(self) -> PredictiveWeights:
        """
        PredictiveWeights
        """
    @weights.setter
    def weights(self, arg0: PredictiveWeights) -> None: ...

class ServoSettings:
    """
    Position servos: k_p (s* - s) - k_d s', k_d = passive + 2 ratio sqrt(k_p M_jj).
    """
    def __copy__(self) -> ServoSettings: ...
    def __deepcopy__(self, arg0: dict) -> ServoSettings: ...
    def __getstate__(self) -> dict: ...
    def __init__(self, **kwargs) -> None: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def damping_ratio(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (joints,)
        """
    @damping_ratio.setter
    def damping_ratio(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None: ...
    @property
    def passive(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (joints,) [N m s/rad]
        """
    @passive.setter
    def passive(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None: ...
    @property
    def stiffness(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (joints,) k_p [N m/rad]
        """
    @stiffness.setter
    def stiffness(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None: ...

class ServoIntegrator:
    """
    How a robot with servos is advanced.

    Members:

      implicit : servos implicit, one mass matrix a step

      runge_kutta_4 : fourth order, robot and jets
    """

    __members__: typing.ClassVar[dict[str, ServoIntegrator]]
    implicit: typing.ClassVar[ServoIntegrator]
    runge_kutta_4: typing.ClassVar[ServoIntegrator]
    @typing.overload
    def __eq__(self, other: ServoIntegrator) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: ServoIntegrator) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class ServoPlantSettings:
    """
    A robot with position servos.
    """
    def __copy__(self) -> ServoPlantSettings: ...
    def __deepcopy__(self, arg0: dict) -> ServoPlantSettings: ...
    def __getstate__(self) -> dict: ...
    def __init__(self, **kwargs) -> None: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def integrator(self) -> ServoIntegrator:
        """
        ServoIntegrator
        """
    @integrator.setter
    def integrator(self, arg0: ServoIntegrator) -> None: ...
    @property
    def servo(self) -> ServoSettings:
        """
        ServoSettings
        """
    @servo.setter
    def servo(self, arg0: ServoSettings) -> None: ...
    @property
    def step(self) -> float:
        """
        at most [s]
        """
    @step.setter
    def step(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class FuelRate:
    """
    Fuel of one jet: idle + per_newton T.
    """
    def __copy__(self) -> FuelRate: ...
    def __deepcopy__(self, arg0: dict) -> FuelRate: ...
    def __getstate__(self) -> dict: ...
    def __init__(self, **kwargs) -> None: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def idle(self) -> float:
        """
        [kg/s]
        """
    @idle.setter
    def idle(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def per_newton(self) -> float:
        """
        [kg/s/N]
        """
    @per_newton.setter
    def per_newton(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class QpStatus:
    """
    How a box QP ended.

    Members:

      solved : KKT residual at most 1e-9

      iteration_limit : best point found is returned

      not_positive_definite : a Cholesky pivot of the free block is not positive

      bad_data : a value is not a number, or bounds are crossed
    """

    __members__: typing.ClassVar[dict[str, QpStatus]]
    bad_data: typing.ClassVar[QpStatus]
    iteration_limit: typing.ClassVar[QpStatus]
    not_positive_definite: typing.ClassVar[QpStatus]
    solved: typing.ClassVar[QpStatus]
    @typing.overload
    def __eq__(self, other: QpStatus) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: QpStatus) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class BoxQpResult:
    """
    Solution of a box QP with its certificate.
    """
    @property
    def iterations(self) -> int:
        """
        Cholesky factorizations
        """
    @property
    def kkt_residual(self) -> float:
        """
        largest violation of the optimality conditions, relative to the terms of the gradient; independent of the variables' units
        """
    @property
    def multipliers(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,) H x + g at the solution: >= 0 where x is at its lower bound, <= 0 at its upper, 0 elsewhere
        """
    @property
    def status(self) -> QpStatus:
        """
        QpStatus
        """
    @property
    def x(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,) the minimizer
        """

class BoxQpSolver:
    """
    Box QP solver of one size that starts from its last working set.
    """
    def __init__(self, size: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def reset(self) -> None:
        """
        Forget the last working set.
        """
    def solve(
        self,
        H: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
        g: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
        lower: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
        upper: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    ) -> BoxQpResult:
        """
        As solve_box_qp, warm-started from the last call.
        """
    @property
    def size(self) -> int:
        """
        largest number of unknowns
        """

class Integrator:
    """
    How the plant is advanced over a control step.

    Members:

      euler : explicit, the published one

      semi_implicit_euler

      runge_kutta_4 : fourth order on the Lie group
    """

    __members__: typing.ClassVar[dict[str, Integrator]]
    euler: typing.ClassVar[Integrator]
    runge_kutta_4: typing.ClassVar[Integrator]
    semi_implicit_euler: typing.ClassVar[Integrator]
    @typing.overload
    def __eq__(self, other: Integrator) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: Integrator) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class ContactPoint:
    """
    A point monitored for ground contact.
    """
    def __copy__(self) -> ContactPoint: ...
    def __deepcopy__(self, arg0: dict) -> ContactPoint: ...
    def __getstate__(self) -> dict: ...
    def __init__(self, **kwargs) -> None: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def frame(self) -> str:
        """
        name
        """
    @frame.setter
    def frame(self, arg0: str) -> None: ...
    @property
    def position(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) in the frame [m]
        """
    @position.setter
    def position(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...

class CommandWindow:
    """
    Pilot's command at samples with start < t < end; signs of the speeds.
    """
    def __copy__(self) -> CommandWindow: ...
    def __deepcopy__(self, arg0: dict) -> CommandWindow: ...
    def __getstate__(self) -> dict: ...
    def __init__(self, **kwargs) -> None: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def end(self) -> float:
        """
        [s]
        """
    @end.setter
    def end(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def front(self) -> float:
        """
        -1 to 1, of the speed
        """
    @front.setter
    def front(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def left(self) -> float:
        """
        -1 to 1, of the speed
        """
    @left.setter
    def left(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def pitch(self) -> float:
        """
        -1 to 1, of the speed
        """
    @pitch.setter
    def pitch(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def roll(self) -> float:
        """
        -1 to 1, of the speed
        """
    @roll.setter
    def roll(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def start(self) -> float:
        """
        [s]
        """
    @start.setter
    def start(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def up(self) -> float:
        """
        -1 to 1, of the speed
        """
    @up.setter
    def up(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def yaw(self) -> float:
        """
        -1 to 1, of the speed
        """
    @yaw.setter
    def yaw(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class CommandSpeeds:
    """
    Change of the reference per second.
    """
    def __copy__(self) -> CommandSpeeds: ...
    def __deepcopy__(self, arg0: dict) -> CommandSpeeds: ...
    def __getstate__(self) -> dict: ...
    def __init__(self, **kwargs) -> None: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def front(self) -> float:
        """
        [m/s]
        """
    @front.setter
    def front(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def left(self) -> float:
        """
        [m/s]
        """
    @left.setter
    def left(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def pitch(self) -> float:
        """
        [rad/s]
        """
    @pitch.setter
    def pitch(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def roll(self) -> float:
        """
        [rad/s]
        """
    @roll.setter
    def roll(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def up(self) -> float:
        """
        [m/s]
        """
    @up.setter
    def up(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def yaw(self) -> float:
        """
        [rad/s]
        """
    @yaw.setter
    def yaw(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class ReferenceSettings:
    """
    From commands to references.
    """
    def __copy__(self) -> ReferenceSettings: ...
    def __deepcopy__(self, arg0: dict) -> ReferenceSettings: ...
    def __getstate__(self) -> dict: ...
    def __init__(self, **kwargs) -> None: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def angular_velocity_time(self) -> float:
        """
        [s]
        """
    @angular_velocity_time.setter
    def angular_velocity_time(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def com_time(self) -> float:
        """
        [s]
        """
    @com_time.setter
    def com_time(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def jerk_time(self) -> float:
        """
        [s]
        """
    @jerk_time.setter
    def jerk_time(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def pitch_max(self) -> float:
        """
        [rad]
        """
    @pitch_max.setter
    def pitch_max(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def pitch_min(self) -> float:
        """
        [rad]
        """
    @pitch_min.setter
    def pitch_min(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def roll_max(self) -> float:
        """
        [rad]
        """
    @roll_max.setter
    def roll_max(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def roll_min(self) -> float:
        """
        [rad]
        """
    @roll_min.setter
    def roll_min(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def rotation_gain(self) -> float:
        """
        [1/s]
        """
    @rotation_gain.setter
    def rotation_gain(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class Gains:
    """
    Gains of the momentum, attitude, posture and torque loops.
    """
    def __copy__(self) -> Gains: ...
    def __deepcopy__(self, arg0: dict) -> Gains: ...
    def __getstate__(self) -> dict: ...
    def __init__(self, **kwargs) -> None: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def attitude_derivative(self) -> float:
        """
        c1
        """
    @attitude_derivative.setter
    def attitude_derivative(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def attitude_proportional(self) -> float:
        """
        c0
        """
    @attitude_proportional.setter
    def attitude_proportional(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def momentum_derivative(self) -> float:
        """
        K_D
        """
    @momentum_derivative.setter
    def momentum_derivative(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def momentum_integral(self) -> float:
        """
        K_O, its inverse enters
        """
    @momentum_integral.setter
    def momentum_integral(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def momentum_proportional(self) -> float:
        """
        K_P
        """
    @momentum_proportional.setter
    def momentum_proportional(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def observer(self) -> float:
        """
        of the momentum observer [1/s]; 0: none
        """
    @observer.setter
    def observer(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def posture(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (joints,) K_s [1/s]
        """
    @posture.setter
    def posture(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None: ...
    @property
    def torque_integral(self) -> float:
        """
        k_I [1/s^2]
        """
    @torque_integral.setter
    def torque_integral(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def torque_proportional(self) -> float:
        """
        k_P [1/s]
        """
    @torque_proportional.setter
    def torque_proportional(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class Weights:
    """
    Weights of the momentum QP and the torque QP.
    """
    def __copy__(self) -> Weights: ...
    def __deepcopy__(self, arg0: dict) -> Weights: ...
    def __getstate__(self) -> dict: ...
    def __init__(self, **kwargs) -> None: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def constant_inertia(self) -> float:
        """
        of the task that keeps the inertia constant
        """
    @constant_inertia.setter
    def constant_inertia(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def joint_velocity(self) -> float:
        """
        of joint velocities
        """
    @joint_velocity.setter
    def joint_velocity(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def momentum(self) -> float:
        """
        of the momentum's squared error
        """
    @momentum.setter
    def momentum(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def posture(self) -> float:
        """
        of the distance from the initial posture
        """
    @posture.setter
    def posture(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def regularization(self) -> float:
        """
        of everything, so that the solution is unique
        """
    @regularization.setter
    def regularization(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def thrust_rate(self) -> float:
        """
        of thrust rates
        """
    @thrust_rate.setter
    def thrust_rate(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def thrust_symmetry(self) -> float:
        """
        of differences within symmetry_pairs
        """
    @thrust_symmetry.setter
    def thrust_symmetry(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def torque(self) -> float:
        """
        of torques, in the torque QP
        """
    @torque.setter
    def torque(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class Limits:
    """
    Ranges of joints, thrusts and torques.
    """
    def __copy__(self) -> Limits: ...
    def __deepcopy__(self, arg0: dict) -> Limits: ...
    def __getstate__(self) -> dict: ...
    def __init__(self, **kwargs) -> None: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def joint_lower(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (joints,) [rad], before scaling; empty: the model's
        """
    @joint_lower.setter
    def joint_lower(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None: ...
    @property
    def joint_range_scale(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (joints,)
        """
    @joint_range_scale.setter
    def joint_range_scale(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None: ...
    @property
    def joint_slope(self) -> float:
        """
        [1/rad]
        """
    @joint_slope.setter
    def joint_slope(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def joint_speed(self) -> float:
        """
        [rad/s]
        """
    @joint_speed.setter
    def joint_speed(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def joint_upper(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (joints,) [rad], before scaling; empty: the model's
        """
    @joint_upper.setter
    def joint_upper(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None: ...
    @property
    def thrust_slope(self) -> float:
        """
        [1/N]
        """
    @thrust_slope.setter
    def thrust_slope(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def torque(self) -> float:
        """
        [Nm]
        """
    @torque.setter
    def torque(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def torque_rate(self) -> float:
        """
        [Nm/s]
        """
    @torque_rate.setter
    def torque_rate(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class JointGroup:
    """
    Joints of one term of the velocity objective.
    """
    def __copy__(self) -> JointGroup: ...
    def __deepcopy__(self, arg0: dict) -> JointGroup: ...
    def __getstate__(self) -> dict: ...
    def __init__(self, **kwargs) -> None: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def joints(self) -> list[str]:
        """
        names
        """
    @joints.setter
    def joints(self, arg0: collections.abc.Sequence[str]) -> None: ...
    @property
    def name(self) -> str:
        """
        of the group
        """
    @name.setter
    def name(self, arg0: str) -> None: ...
    @property
    def weight(self) -> float:
        """
        of its velocity in the objective
        """
    @weight.setter
    def weight(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class FailureLimits:
    """
    The flight is lost beyond these.
    """
    def __copy__(self) -> FailureLimits: ...
    def __deepcopy__(self, arg0: dict) -> FailureLimits: ...
    def __getstate__(self) -> dict: ...
    def __init__(self, **kwargs) -> None: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def attitude_error(self) -> float:
        """
        [rad]
        """
    @attitude_error.setter
    def attitude_error(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def com_error(self) -> float:
        """
        [m]
        """
    @com_error.setter
    def com_error(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def joint_speed(self) -> float:
        """
        [rad/s]
        """
    @joint_speed.setter
    def joint_speed(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class Turbine:
    """
    Second-order jet: T'' = f + g (U + B_UU U^2), f = K_T T + K_TT T^2 + K_D T' + K_DD T'^2 + K_TD T T' + c, g = B_U + B_T T + B_D T'; thrust T [N], throttle U [%].
    """
    def __copy__(self) -> Turbine: ...
    def __deepcopy__(self, arg0: dict) -> Turbine: ...
    def __getstate__(self) -> dict: ...
    def __init__(self, **kwargs) -> None: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def B_D(self) -> float: ...
    @B_D.setter
    def B_D(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def B_T(self) -> float: ...
    @B_T.setter
    def B_T(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def B_U(self) -> float: ...
    @B_U.setter
    def B_U(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def B_UU(self) -> float: ...
    @B_UU.setter
    def B_UU(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def K_D(self) -> float: ...
    @K_D.setter
    def K_D(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def K_DD(self) -> float: ...
    @K_DD.setter
    def K_DD(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def K_T(self) -> float: ...
    @K_T.setter
    def K_T(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def K_TD(self) -> float: ...
    @K_TD.setter
    def K_TD(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def K_TT(self) -> float: ...
    @K_TT.setter
    def K_TT(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def c(self) -> float: ...
    @c.setter
    def c(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def rate_gain(self) -> float:
        """
        of the feedback linearization that follows a thrust rate [1/s]
        """
    @rate_gain.setter
    def rate_gain(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def throttle_max(self) -> float:
        """
        [%]
        """
    @throttle_max.setter
    def throttle_max(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class RateIntegrator:
    """
    Thrust follows the commanded rate.
    """
    def __copy__(self) -> RateIntegrator: ...
    def __deepcopy__(self, arg0: dict) -> RateIntegrator: ...
    def __getstate__(self) -> dict: ...
    def __init__(self, **kwargs) -> None: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...

class FirstOrderLag:
    """
    A propeller behind its speed controller: T' = (command - T) / time.
    """
    def __copy__(self) -> FirstOrderLag: ...
    def __deepcopy__(self, arg0: dict) -> FirstOrderLag: ...
    def __getstate__(self) -> dict: ...
    def __init__(self, **kwargs) -> None: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def time(self) -> float:
        """
        [s]
        """
    @time.setter
    def time(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class Actuator:
    """
    What pushes the robot along a line fixed in a frame: a jet, a propeller.
    """
    def __copy__(self) -> Actuator: ...
    def __deepcopy__(self, arg0: dict) -> Actuator: ...
    def __getstate__(self) -> dict: ...
    def __init__(self, **kwargs) -> None: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def axis(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) unit vector in the frame; thrust pushes along
        """
    @axis.setter
    def axis(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def dynamics(self) -> RateIntegrator | FirstOrderLag | Turbine | StandardizedTurbine:
        """
        RateIntegrator, FirstOrderLag, Turbine or StandardizedTurbine
        """
    @dynamics.setter
    def dynamics(self, arg0: RateIntegrator | FirstOrderLag | Turbine | StandardizedTurbine) -> None: ...
    @property
    def frame(self) -> str:
        """
        name
        """
    @frame.setter
    def frame(self, arg0: str) -> None: ...
    @property
    def reaction(self) -> float:
        """
        moment about the axis per thrust, as of a propeller's drag [N m/N]
        """
    @reaction.setter
    def reaction(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def thrust_max(self) -> float:
        """
        [N]
        """
    @thrust_max.setter
    def thrust_max(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def thrust_min(self) -> float:
        """
        [N]
        """
    @thrust_min.setter
    def thrust_min(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def thrust_rate(self) -> float:
        """
        largest [N/s]
        """
    @thrust_rate.setter
    def thrust_rate(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class Disturbances:
    """
    What the controller does not know.
    """
    def __copy__(self) -> Disturbances: ...
    def __deepcopy__(self, arg0: dict) -> Disturbances: ...
    def __getstate__(self) -> dict: ...
    def __init__(self, **kwargs) -> None: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def gust_deviation(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) standard deviation of the gusts [N]
        """
    @gust_deviation.setter
    def gust_deviation(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def gust_time(self) -> float:
        """
        correlation time [s]
        """
    @gust_time.setter
    def gust_time(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def mass_deviation(self) -> float:
        """
        relative standard deviation, drawn per body
        """
    @mass_deviation.setter
    def mass_deviation(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def mass_scale(self) -> float:
        """
        plant's inertias over the model's
        """
    @mass_scale.setter
    def mass_scale(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def seed(self) -> int:
        """
        of gusts and drawn deviations
        """
    @seed.setter
    def seed(self, arg0: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def thrust_deviation(self) -> float:
        """
        relative standard deviation, drawn per jet
        """
    @thrust_deviation.setter
    def thrust_deviation(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def thrust_scale(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (jets,) plant's thrust over the jet's; empty: 1
        """
    @thrust_scale.setter
    def thrust_scale(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None: ...
    @property
    def wind_force(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) on the base's origin, world axes [N]
        """
    @wind_force.setter
    def wind_force(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def wind_velocity(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) of the air that drags, world axes [m/s]
        """
    @wind_velocity.setter
    def wind_velocity(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...

class TrimSettings:
    """
    Which hover a flight starts in.
    """
    def __copy__(self) -> TrimSettings: ...
    def __deepcopy__(self, arg0: dict) -> TrimSettings: ...
    def __getstate__(self) -> dict: ...
    def __init__(self, **kwargs) -> None: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def iterations(self) -> int:
        """
        at most
        """
    @iterations.setter
    def iterations(self, arg0: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def joints(self) -> list[str]:
        """
        names of those that may move
        """
    @joints.setter
    def joints(self, arg0: collections.abc.Sequence[str]) -> None: ...
    @property
    def largest_step(self) -> float:
        """
        of a joint in one iteration [rad, m]
        """
    @largest_step.setter
    def largest_step(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def thrust_weight(self) -> float:
        """
        [1/N]
        """
    @thrust_weight.setter
    def thrust_weight(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def tilt_weight(self) -> float:
        """
        [1/rad]
        """
    @tilt_weight.setter
    def tilt_weight(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def tolerance(self) -> float:
        """
        of the residual [N, N m]
        """
    @tolerance.setter
    def tolerance(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class Friction:
    """
    Of the joints' drives, in the plant only: viscous s' + coulomb tanh(s' / slip_speed).
    """
    def __copy__(self) -> Friction: ...
    def __deepcopy__(self, arg0: dict) -> Friction: ...
    def __getstate__(self) -> dict: ...
    def __init__(self, **kwargs) -> None: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def coulomb(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (joints,) [N m]; empty: none
        """
    @coulomb.setter
    def coulomb(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None: ...
    @property
    def slip_speed(self) -> float:
        """
        of the smooth sign [rad/s]
        """
    @slip_speed.setter
    def slip_speed(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def viscous(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (joints,) [N m s/rad]; empty: none
        """
    @viscous.setter
    def viscous(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None: ...

class Delays:
    """
    How late the robot gets what the controllers ask for.
    """
    def __copy__(self) -> Delays: ...
    def __deepcopy__(self, arg0: dict) -> Delays: ...
    def __getstate__(self) -> dict: ...
    def __init__(self, **kwargs) -> None: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def momentum(self) -> float:
        """
        thrust rates and joint velocities; whole steps of the loop [s]
        """
    @momentum.setter
    def momentum(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def torque(self) -> float:
        """
        whole periods of the torque loop [s]
        """
    @torque.setter
    def torque(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def torque_lag(self) -> float:
        """
        time constant of the drives [s]; 0: none
        """
    @torque_lag.setter
    def torque_lag(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class DragArea:
    """
    What air drags: force -0.5 rho area |u| u, u against the air.
    """
    def __copy__(self) -> DragArea: ...
    def __deepcopy__(self, arg0: dict) -> DragArea: ...
    def __getstate__(self) -> dict: ...
    def __init__(self, **kwargs) -> None: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def area(self) -> float:
        """
        C_d A [m^2]
        """
    @area.setter
    def area(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def frame(self) -> str:
        """
        name
        """
    @frame.setter
    def frame(self, arg0: str) -> None: ...
    @property
    def position(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) in the frame [m]
        """
    @position.setter
    def position(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...

class Tank:
    """
    Fuel on board, part of its link's inertia at the start; the controller does not see it go.
    """
    def __copy__(self) -> Tank: ...
    def __deepcopy__(self, arg0: dict) -> Tank: ...
    def __getstate__(self) -> dict: ...
    def __init__(self, **kwargs) -> None: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    @property
    def consumption(self) -> float:
        """
        [kg/(N s)]
        """
    @consumption.setter
    def consumption(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def frame(self) -> str:
        """
        name
        """
    @frame.setter
    def frame(self, arg0: str) -> None: ...
    @property
    def fuel(self) -> float:
        """
        [kg]
        """
    @fuel.setter
    def fuel(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def position(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) of the fuel, in the frame [m]
        """
    @position.setter
    def position(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...

class FlightSettings:
    """
    Everything that decides a flight besides the robot; SI units. Vectors over joints have the order of `joints`, vectors over jets that of `actuators`. Assign lists and arrays whole.
    """
    def __copy__(self) -> FlightSettings: ...
    def __deepcopy__(self, arg0: dict) -> FlightSettings: ...
    def __getstate__(self) -> dict: ...
    def __init__(self, **kwargs) -> None: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, arg0: dict) -> None: ...
    def validate(self) -> None:
        """
        Raise ValueError naming the first attribute that is wrong.
        """
    @property
    def actuators(self) -> list[Actuator]:
        """
        list of Actuator
        """
    @actuators.setter
    def actuators(self, arg0: collections.abc.Sequence[Actuator]) -> None: ...
    @property
    def air_density(self) -> float:
        """
        [kg/m^3]
        """
    @air_density.setter
    def air_density(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def base_pose(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[4, 4]"]:
        """
        (4, 4)
        """
    @base_pose.setter
    def base_pose(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 4]"]) -> None: ...
    @property
    def command_speeds(self) -> CommandSpeeds:
        """
        of full commands
        """
    @command_speeds.setter
    def command_speeds(self, arg0: CommandSpeeds) -> None: ...
    @property
    def contact_points(self) -> list[ContactPoint]:
        """
        list of ContactPoint
        """
    @contact_points.setter
    def contact_points(self, arg0: collections.abc.Sequence[ContactPoint]) -> None: ...
    @property
    def controller(self) -> Controller:
        """
        Controller
        """
    @controller.setter
    def controller(self, arg0: Controller) -> None: ...
    @property
    def delays(self) -> Delays:
        """
        of what the controllers ask for
        """
    @delays.setter
    def delays(self, arg0: Delays) -> None: ...
    @property
    def disturbances(self) -> Disturbances:
        """
        of the plant
        """
    @disturbances.setter
    def disturbances(self, arg0: Disturbances) -> None: ...
    @property
    def drag(self) -> list[DragArea]:
        """
        list of DragArea
        """
    @drag.setter
    def drag(self, arg0: collections.abc.Sequence[DragArea]) -> None: ...
    @property
    def duration(self) -> float:
        """
        [s]
        """
    @duration.setter
    def duration(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def failure(self) -> FailureLimits:
        """
        where the flight is lost
        """
    @failure.setter
    def failure(self, arg0: FailureLimits) -> None: ...
    @property
    def friction(self) -> Friction:
        """
        of the joints' drives
        """
    @friction.setter
    def friction(self, arg0: Friction) -> None: ...
    @property
    def fuel(self) -> FuelRate:
        """
        of each jet
        """
    @fuel.setter
    def fuel(self, arg0: FuelRate) -> None: ...
    @property
    def gains(self) -> Gains:
        """
        of all loops
        """
    @gains.setter
    def gains(self, arg0: Gains) -> None: ...
    @property
    def ground_height(self) -> float:
        """
        [m]
        """
    @ground_height.setter
    def ground_height(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def groups(self) -> list[JointGroup]:
        """
        list of JointGroup
        """
    @groups.setter
    def groups(self, arg0: collections.abc.Sequence[JointGroup]) -> None: ...
    @property
    def hold_inertia(self) -> bool:
        """
        torque updates between two momentum QPs take the joint-space inertia of the last momentum QP
        """
    @hold_inertia.setter
    def hold_inertia(self, arg0: bool) -> None: ...
    @property
    def initial_free_fall(self) -> bool:
        """
        first step without jets and torques, as published
        """
    @initial_free_fall.setter
    def initial_free_fall(self, arg0: bool) -> None: ...
    @property
    def initial_joints(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (joints,) [rad]
        """
    @initial_joints.setter
    def initial_joints(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None: ...
    @property
    def initial_thrusts(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (jets,) [N]
        """
    @initial_thrusts.setter
    def initial_thrusts(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None: ...
    @property
    def integrator(self) -> Integrator:
        """
        of the plant
        """
    @integrator.setter
    def integrator(self, arg0: Integrator) -> None: ...
    @property
    def joints(self) -> list[str]:
        """
        names
        """
    @joints.setter
    def joints(self, arg0: collections.abc.Sequence[str]) -> None: ...
    @property
    def limits(self) -> Limits:
        """
        of joints, thrusts, torques
        """
    @limits.setter
    def limits(self, arg0: Limits) -> None: ...
    @property
    def path(self) -> WaypointPath:
        """
        replaces the commands if it has way-points
        """
    @path.setter
    def path(self, arg0: WaypointPath) -> None: ...
    @property
    def posture_reference(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (joints,) [rad]; empty: the angles at the start
        """
    @posture_reference.setter
    def posture_reference(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None: ...
    @property
    def predictive(self) -> PredictiveSettings:
        """
        of that controller
        """
    @predictive.setter
    def predictive(self, arg0: PredictiveSettings) -> None: ...
    @property
    def pulses(self) -> list[Pulse]:
        """
        list of Pulse
        """
    @pulses.setter
    def pulses(self, arg0: collections.abc.Sequence[Pulse]) -> None: ...
    @property
    def reference(self) -> ReferenceSettings:
        """
        from commands to references
        """
    @reference.setter
    def reference(self, arg0: ReferenceSettings) -> None: ...
    @property
    def rotation_deadband(self) -> float:
        """
        base rotations of a plant step below this are dropped [rad]; published: 1e-6
        """
    @rotation_deadband.setter
    def rotation_deadband(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def rotor_inertia(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (joints,) of the drives as their joints feel it [kg m^2]; empty: none
        """
    @rotor_inertia.setter
    def rotor_inertia(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None: ...
    @property
    def samples(self) -> int:
        """
        number of samples of the flight
        """
    @property
    def servo_plant(self) -> ServoPlantSettings:
        """
        of that controller's robot
        """
    @servo_plant.setter
    def servo_plant(self, arg0: ServoPlantSettings) -> None: ...
    @property
    def step(self) -> float:
        """
        of the momentum loop, jets and samples [s]
        """
    @step.setter
    def step(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def substeps(self) -> int:
        """
        plant steps per torque update
        """
    @substeps.setter
    def substeps(self, arg0: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def symmetry_pairs(self) -> list[tuple[int, int]]:
        """
        pairs of jet indices
        """
    @symmetry_pairs.setter
    def symmetry_pairs(
        self,
        arg0: collections.abc.Sequence[
            tuple[typing.SupportsInt | typing.SupportsIndex, typing.SupportsInt | typing.SupportsIndex]
        ],
    ) -> None: ...
    @property
    def tank(self) -> Tank | None:
        """
        Tank or None
        """
    @tank.setter
    def tank(self, arg0: Tank | None) -> None: ...
    @property
    def torque_updates(self) -> int:
        """
        of the torque loop per step, evenly spaced
        """
    @torque_updates.setter
    def torque_updates(self, arg0: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def trajectory(self) -> list[CommandWindow]:
        """
        list of CommandWindow
        """
    @trajectory.setter
    def trajectory(self, arg0: collections.abc.Sequence[CommandWindow]) -> None: ...
    @property
    def trim(self) -> TrimSettings | None:
        """
        TrimSettings: start in the hover nearest to the initial state; None: in it
        """
    @trim.setter
    def trim(self, arg0: TrimSettings | None) -> None: ...
    @property
    def weights(self) -> Weights:
        """
        of the QPs
        """
    @weights.setter
    def weights(self, arg0: Weights) -> None: ...

class FlightStatus:
    """
    Whether the flight reached its end.

    Members:

      completed

      failed
    """

    __members__: typing.ClassVar[dict[str, FlightStatus]]
    completed: typing.ClassVar[FlightStatus]
    failed: typing.ClassVar[FlightStatus]
    @typing.overload
    def __eq__(self, other: FlightStatus) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: FlightStatus) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class FlightObjectives:
    """
    One family of objectives, to be minimized.
    """
    @property
    def joint_velocity(self) -> float:
        """
        of velocity minus command, groups weighted; units of the family
        """
    @property
    def momentum(self) -> float:
        """
        of linear and angular momentum error; units of the family, docs/flight.md
        """
    @property
    def thrust(self) -> float:
        """
        mean total thrust [N]
        """

class ObjectiveParts:
    """
    Terms of a family before they are added.
    """
    @property
    def angular_momentum(self) -> float:
        """
        units of the family; rms: [kg m^2/s]
        """
    @property
    def joint_velocity(self) -> list[float]:
        """
        one per joint group, without its weight
        """
    @property
    def linear_momentum(self) -> float:
        """
        units of the family; rms: [kg m/s]
        """

class FlightProfile:
    """
    Wall time of a flight by phase of the step [s].
    """
    @property
    def log(self) -> float:
        """
        checks and histories
        """
    @property
    def momentum_qp(self) -> float:
        """
        solution of the momentum QP
        """
    @property
    def plant(self) -> float:
        """
        integration, jets
        """
    @property
    def task(self) -> float:
        """
        references, building of the momentum QP
        """
    @property
    def terms(self) -> float:
        """
        kinematics, inertias, mass matrix and its factorization, Jacobians
        """
    @property
    def torque(self) -> float:
        """
        torque QP and rate limiter
        """

class FlightMeasures:
    """
    Tracking, energy and fuel of a flight.
    """
    @property
    def attitude_error_rms(self) -> float:
        """
        of the norm of the roll, pitch and yaw errors [rad]
        """
    @property
    def com_error_rms(self) -> float:
        """
        [m]
        """
    @property
    def final_com_error(self) -> float:
        """
        [m]
        """
    @property
    def fuel(self) -> float:
        """
        [kg]
        """
    @property
    def hover_margin(self) -> float:
        """
        1 - largest share of its limit that an initial thrust takes
        """
    @property
    def max_attitude_error(self) -> float:
        """
        norm of the roll, pitch and yaw errors [rad]
        """
    @property
    def max_com_error(self) -> float:
        """
        [m]
        """
    @property
    def mechanical_energy(self) -> float:
        """
        sum over the joints of the integral of |torque velocity| [J]
        """
    @property
    def peak_power(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (joints,) [W]
        """
    @property
    def peak_speed(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (joints,) [rad/s]
        """
    @property
    def peak_torque(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (joints,) [N m]
        """
    @property
    def pose_error_rms(self) -> float:
        """
        of sqrt(|center of mass error|^2 + (1 m angle)^2) [m]
        """
    @property
    def positive_energy(self) -> float:
        """
        of its positive part [J]
        """
    @property
    def thrust_impulse(self) -> float:
        """
        [N s]
        """

class FlightLog:
    """
    What happened in a flight: histories (read-only arrays that share the log's memory), status and summary. SI units, world axes.
    """
    @property
    def active_bounds(self) -> numpy.ndarray:
        """
        (N,) of the momentum QP
        """
    @property
    def angular_velocity_reference(self) -> numpy.ndarray:
        """
        (N, 3) base axes [rad/s]
        """
    @property
    def base_position(self) -> numpy.ndarray:
        """
        (N, 3) [m]
        """
    @property
    def base_rotation(self) -> numpy.ndarray:
        """
        (N, 3, 3) world_R_base
        """
    @property
    def clearance(self) -> numpy.ndarray:
        """
        (N,) lowest contact point above the ground [m]
        """
    @property
    def com(self) -> numpy.ndarray:
        """
        (N, 3) [m]
        """
    @property
    def com_reference(self) -> numpy.ndarray:
        """
        (N, 3) [m]
        """
    @property
    def com_velocity_reference(self) -> numpy.ndarray:
        """
        (N, 3) [m/s]
        """
    @property
    def completed(self) -> bool:
        """
        whether the status says so
        """
    @property
    def failure_reason(self) -> str | None:
        """
        text, or None
        """
    @property
    def failure_time(self) -> float | None:
        """
        [s], or None
        """
    @property
    def fuel_burnt(self) -> float:
        """
        [kg]
        """
    @property
    def ground_touched(self) -> bool:
        """
        whether a contact point was below the ground
        """
    @property
    def joint_positions(self) -> numpy.ndarray:
        """
        (N, joints) [rad]
        """
    @property
    def joint_velocity_command(self) -> numpy.ndarray:
        """
        (N, joints) [rad/s]
        """
    @property
    def max_attitude_error(self) -> float:
        """
        [rad]
        """
    @property
    def max_com_error(self) -> float:
        """
        [m]
        """
    @property
    def max_joint_speed(self) -> float:
        """
        [rad/s]
        """
    @property
    def max_thrust(self) -> float:
        """
        [N]
        """
    @property
    def max_torque(self) -> float:
        """
        [Nm]
        """
    @property
    def measures(self) -> FlightMeasures:
        """
        FlightMeasures
        """
    @property
    def min_clearance(self) -> float:
        """
        [m]
        """
    @property
    def min_thrust(self) -> float:
        """
        [N]
        """
    @property
    def momentum(self) -> numpy.ndarray:
        """
        (N, 6) linear, angular about the center of mass
        """
    @property
    def momentum_error(self) -> numpy.ndarray:
        """
        (N, 6) E_l, E_w
        """
    @property
    def paper(self) -> FlightObjectives:
        """
        FlightObjectives as the paper defines them
        """
    @property
    def profile(self) -> FlightProfile:
        """
        FlightProfile
        """
    @property
    def qp_failures(self) -> int:
        """
        steps in which a QP was not solved
        """
    @property
    def qp_iterations(self) -> numpy.ndarray:
        """
        (N, 2) linear systems solved for the momentum and the torque QP
        """
    @property
    def rms(self) -> FlightObjectives:
        """
        FlightObjectives: root mean squares, SI
        """
    @property
    def rms_parts(self) -> ObjectiveParts:
        """
        terms of rms
        """
    @property
    def rotation_reference(self) -> numpy.ndarray:
        """
        (N, 3, 3)
        """
    @property
    def samples(self) -> int:
        """
        N, how many there are
        """
    @property
    def script(self) -> FlightObjectives:
        """
        FlightObjectives as the authors' program prints them
        """
    @property
    def script_parts(self) -> ObjectiveParts:
        """
        terms of script
        """
    @property
    def status(self) -> FlightStatus:
        """
        FlightStatus
        """
    @property
    def step(self) -> float:
        """
        between samples [s]
        """
    @property
    def thrust(self) -> numpy.ndarray:
        """
        (N, jets) [N]
        """
    @property
    def thrust_command(self) -> numpy.ndarray:
        """
        (N, jets) a rate [N/s], a thrust [N] or a throttle [%]
        """
    @property
    def thrust_rate_command(self) -> numpy.ndarray:
        """
        (N, jets) [N/s]
        """
    @property
    def time(self) -> numpy.ndarray:
        """
        (N,) [s]
        """
    @property
    def torque(self) -> numpy.ndarray:
        """
        (N, joints) [Nm]
        """
    @property
    def total_qp_iterations(self) -> int:
        """
        linear systems solved for both QPs
        """
    @property
    def unmodeled_force(self) -> numpy.ndarray:
        """
        (N, 6) force and moment about the center of mass that the momentum observer estimates [N, N m]; 0 without observer
        """
    @property
    def velocity(self) -> numpy.ndarray:
        """
        (N, 6 + joints) mixed
        """
    @property
    def wind(self) -> numpy.ndarray:
        """
        (N, 3) force on the base's origin [N]
        """

class RobotState:
    """
    Of a floating-base robot: base velocity is that of the base's origin, world axes, then its angular velocity, world axes.
    """
    def __init__(
        self,
        *,
        base_rotation: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 3]"],
        base_position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        joints: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
    ) -> None:
        """
        base_rotation (3, 3), base_position (3,) [m], joints (n,) [rad or m], velocity (6 + n,) [m/s, rad/s].
        """
    @property
    def base_position(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) [m]
        """
    @property
    def base_rotation(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 3]"]:
        """
        (3, 3) from base to world axes
        """
    @property
    def joints(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,) [rad or m]
        """
    @property
    def velocity(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (6 + n,) [m/s, rad/s]
        """

class PlantInputs:
    """
    What acts on the robot over one period, held.
    """
    @property
    def base_force(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) gusts, on the base's origin, world axes [N]
        """
    @property
    def base_moment(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) on the base, world axes [N m]
        """
    @property
    def com_force(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) pulses, through the center of mass, world axes [N]
        """
    @property
    def thrust(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (jets,) [N]
        """
    @property
    def torque(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (joints,) [N m]
        """

class Trim:
    """
    A state in which a robot hovers, or how near one came to it.
    """
    @property
    def base_pose(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[4, 4]"]:
        """
        (4, 4)
        """
    @property
    def iterations(self) -> int:
        """
        that it took
        """
    @property
    def joints(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (joints,) inside their ranges [rad]
        """
    @property
    def reached(self) -> bool:
        """
        whether the residual is within 1e-9
        """
    @property
    def residual(self) -> float:
        """
        largest entry of the force and moment left over [N, N m]
        """
    @property
    def thrusts(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (actuators,) inside their ranges [N]
        """

class JetPrediction:
    """
    Linear jet of a prediction.
    """
    @property
    def constant(self) -> float:
        """
        [N/s^2]
        """
    @property
    def per_rate(self) -> float:
        """
        [1/s]
        """
    @property
    def per_thrust(self) -> float:
        """
        [1/s^2]
        """
    @property
    def per_variable(self) -> float:
        """
        [N/s^2]
        """
    @property
    def static_gain(self) -> float:
        """
        of thrust per v, held steady [N]
        """
    @property
    def thrust(self) -> float:
        """
        of the linearization [N]
        """
    @property
    def thrust_rate(self) -> float:
        """
        of the linearization [N/s]
        """
    @property
    def variable(self) -> float:
        """
        v of the linearization
        """

class PredictionModel:
    """
    The robot as the predictive controller sees it; body axes.
    """
    @property
    def angular_velocity(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) [rad/s]
        """
    @property
    def force_of_joint(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, n]"]:
        """
        (3, joints) [N/rad]
        """
    @property
    def force_of_thrust(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, n]"]:
        """
        (3, jets) [N/N]
        """
    @property
    def inertia(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 3]"]:
        """
        (3, 3) about the center of mass [kg m^2]
        """
    @property
    def jets(self) -> list[JetPrediction]:
        """
        list of JetPrediction
        """
    @property
    def mass(self) -> float:
        """
        [kg]
        """
    @property
    def moment_of_joint(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, n]"]:
        """
        (3, joints) [N m/rad]
        """
    @property
    def moment_of_thrust(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, n]"]:
        """
        (3, jets) [N m/N]
        """
    @property
    def rpy(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) of the linearization [rad]
        """
    @property
    def rpy_rate(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 3]"]:
        """
        (3, 3) roll, pitch, yaw rates per angular momentum [1/(kg m^2)]
        """
    @property
    def weight(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) [N]
        """
    @property
    def weight_per_rpy(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 3]"]:
        """
        (3, 3) [N/rad]
        """
    @property
    def world_R_body(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 3]"]:
        """
        (3, 3)
        """

class PredictionState:
    """
    What a prediction starts from.
    """
    @property
    def angular_momentum(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) body axes [kg m^2/s]
        """
    @property
    def com(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) world axes [m]
        """
    @property
    def com_integral(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) of its error [m s]
        """
    @property
    def linear_momentum(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) body axes [kg m/s]
        """
    @property
    def rpy(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) of the body, unwrapped [rad]
        """
    @property
    def rpy_integral(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) of its error [rad s]
        """
    @property
    def thrust(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (jets,) [N]
        """
    @property
    def thrust_rate(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (jets,) [N/s]
        """

class PredictiveController:
    """
    Single solves of the predictive controller, to look into it.
    """
    def __init__(self, model: Model, settings: FlightSettings) -> None: ...
    def solve(
        self,
        k: typing.SupportsInt | typing.SupportsIndex,
        base_pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 4]"],
        joints: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        thrusts: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        thrust_rates: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
    ) -> QpStatus:
        """
        The k-th solve, at time k period; moves set points and throttles if it is solved.
        """
    def start(
        self,
        base_pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 4]"],
        joints: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        thrusts: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        set_points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
    ) -> None:
        """
        Begin at a state at rest: its center of mass and attitude are the path's start, the set points home, the throttles those that hold the thrusts.
        """
    @property
    def gradient(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,) of the last solve
        """
    @property
    def hessian(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (n, n) of the last solve
        """
    @property
    def joint_columns(self) -> list[int]:
        """
        first unknown of each block of joint displacements
        """
    @property
    def lower(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,)
        """
    @property
    def prediction(self) -> PredictionModel:
        """
        PredictionModel of the last solve
        """
    @property
    def result(self) -> BoxQpResult:
        """
        BoxQpResult of the last solve
        """
    @property
    def set_points(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (joints,) [rad]
        """
    @property
    def state(self) -> PredictionState:
        """
        PredictionState of the last solve
        """
    @property
    def step_ends(self) -> list[float]:
        """
        of the prediction's steps from the solve [s]
        """
    @property
    def throttle_columns(self) -> list[int]:
        """
        first unknown of each block of throttle variables
        """
    @property
    def throttles(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        [%]
        """
    @property
    def upper(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,)
        """
    @property
    def variables(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (jets,) v of the throttles
        """

def bias_forces(
    model: Model,
    base_pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    s: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    nu: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
) -> numpy.typing.NDArray[numpy.float64]:
    """
    b (6+n,): gravity, Coriolis and centrifugal forces [N, N m].
    """

def center_of_mass(
    model: Model,
    base_pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    s: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
) -> numpy.typing.NDArray[numpy.float64]:
    """
    Center of mass (3,) in the world [m].
    """

def center_of_mass_jacobian(
    model: Model,
    base_pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    s: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
) -> numpy.typing.NDArray[numpy.float64]:
    """
    Jacobian of the center of mass (3, 6+n).
    """

def center_of_mass_velocity(
    model: Model,
    base_pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    s: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    nu: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
) -> numpy.typing.NDArray[numpy.float64]:
    """
    Velocity of the center of mass (3,) [m/s].
    """

def centroidal_momentum(
    model: Model,
    base_pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    s: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    nu: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
) -> numpy.typing.NDArray[numpy.float64]:
    """
    Linear and angular momentum about the center of mass (6,), world axes.
    """

def centroidal_momentum_bias(
    model: Model,
    base_pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    s: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    nu: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
) -> numpy.typing.NDArray[numpy.float64]:
    """
    Rate of C times nu (6,): rate of the momentum where nu_dot = 0.
    """

def centroidal_momentum_matrix(
    model: Model,
    base_pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    s: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
) -> numpy.typing.NDArray[numpy.float64]:
    """
    C (6, 6+n) with C nu = centroidal_momentum.
    """

def check_inertia(
    link: str,
    mass: typing.SupportsFloat | typing.SupportsIndex,
    inertia: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
) -> None:
    """
    Refuses a mass [kg] with an inertia (3, 3) [kg m2] about the center of mass that no body can have.

    Raises: UrdfError naming the link and its principal moments.
    """

def check_urdf(content: bytes, is_utf8: bool = False, as_published: bool = False) -> str:
    """
    Name of the root link of a URDF whose links, joints, inertias and shapes can be used.

    Args:
        content: the text as bytes.
        is_utf8: read it as UTF-8, whatever byte order mark and XML declaration say.
        as_published: accept inertia tensors that no body can have; judged are the links that move as one.
    Raises: UrdfError naming line and element of all faults.
    """

def fitted_settings(model: Model, settings: FlightSettings) -> FlightSettings:
    """
    The settings with what they leave to the model: its joint ranges where they give none, and the state that the flight starts in where it is a trimmed hover. Raises ValueError if model and settings do not fit each other.
    """

def forward_dynamics(
    model: Model,
    base_pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    s: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    nu: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    tau: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    wrenches: dict = {},
) -> numpy.typing.NDArray[numpy.float64]:
    """
    Accelerations nu_dot (6+n,), by the articulated-body algorithm.

    Args:
        tau: (n,) joint torques [N m] or forces [N].
        wrenches: frame name to force and moment (6,) [N, N m], world axes, at the frame's origin.
    Raises: SolverError where the mass matrix is singular.
    """

def frame_bias_acceleration(
    model: Model,
    base_pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    s: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    nu: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    frame: str,
) -> numpy.typing.NDArray[numpy.float64]:
    """
    Rate of J times nu (6,) [m/s^2, rad/s^2].
    """

def frame_jacobian(
    model: Model,
    base_pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    s: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    frame: str,
) -> numpy.typing.NDArray[numpy.float64]:
    """
    J (6, 6+n): velocity of the frame's origin and angular velocity, world axes.
    """

def frame_pose(
    model: Model,
    base_pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    s: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    frame: str,
) -> numpy.typing.NDArray[numpy.float64]:
    """
    Pose (4, 4) of a link in the world.
    """

def frame_velocity(
    model: Model,
    base_pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    s: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    nu: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    frame: str,
) -> numpy.typing.NDArray[numpy.float64]:
    """
    J nu (6,) [m/s, rad/s].
    """

def gravity_forces(
    model: Model,
    base_pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    s: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
) -> numpy.typing.NDArray[numpy.float64]:
    """
    The bias forces at rest (6+n,) [N, N m].
    """

def hull_distances(
    hulls: collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.float64]],
    first: typing.Annotated[numpy.typing.ArrayLike, numpy.int64],
    second: typing.Annotated[numpy.typing.ArrayLike, numpy.int64],
    first_T_second: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
) -> numpy.typing.NDArray[numpy.float64]:
    """
    Signed distances of pairs of convex hulls.

    Args:
        hulls: points (n, 3) of each hull in its own frame [m]; points inside a hull do no harm.
        first, second: (m,) numbers of the hulls of each pair.
        first_T_second: (m, 4, 4) pose of the second hull's frame in the first's.
    Returns: (m,) [m]; where two hulls overlap, minus the length of the shortest translation that parts them.
    Raises: ValueError for wrong shapes, numbers or values that are not finite.
    Source: Gilbert, Johnson, Keerthi (1988); van den Bergen (2001).
    """

def inverse_dynamics(
    model: Model,
    base_pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    s: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    nu: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    nu_dot: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
) -> numpy.typing.NDArray[numpy.float64]:
    """
    M nu_dot + b (6+n,) [N, N m], by the recursive Newton-Euler algorithm.
    """

def kinetic_energy(
    model: Model,
    base_pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    s: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    nu: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
) -> float:
    """
    [J]
    """

def load_urdf(
    text_or_path: typing.Any,
    joints: collections.abc.Sequence[str] | None = None,
    as_published: bool = False,
    fixed_base: bool = False,
) -> Model:
    """
    The robot in a URDF, given as text or as the path of a file.

    Args:
        text_or_path: the text (starts with '<') or a path.
        joints: names of the joints that move, in the wanted order; all others are locked at position
            0 and their links lumped. None: every joint that is not fixed and mimics no other one, in
            the order of the URDF. Joints that mimic one of them move along.
        as_published: accept inertia tensors that no body can have; nothing else is waived.
        fixed_base: hold the root link; nu and all matrices then lose the six base coordinates.
    Raises: UrdfError naming the element; UnknownNameError for a joint that is not there.
    """

def locked_inertia(
    model: Model,
    base_pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    s: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
) -> numpy.typing.NDArray[numpy.float64]:
    """
    Inertia (3, 3) of the robot frozen in its posture, about the center of mass, world axes.
    """

def mass_matrix(
    model: Model,
    base_pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    s: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
) -> numpy.typing.NDArray[numpy.float64]:
    """
    M (6+n, 6+n) of M nu_dot + b = (0, tau) + sum of J^T wrench; mixed convention.
    """

def momentum_qps(
    model: Model, settings: FlightSettings, log: FlightLog, every: typing.SupportsInt | typing.SupportsIndex = 1
) -> list[
    tuple[
        typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"],
        typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
        typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
        typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    ]
]:
    """
    Momentum QPs (H, g, lower, upper) of samples 0, every, 2 every, ... of a flight, rebuilt from its log. Unknowns: thrust rates, then joint velocities. Raises ValueError if the log is not of this model and these settings.
    """

def nearest_approaches(
    bodies: collections.abc.Sequence[collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.float64]]],
    poses: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    pairs: typing.Annotated[numpy.typing.ArrayLike, numpy.int64, "[m, 2]"],
    limit: typing.SupportsFloat | typing.SupportsIndex,
) -> tuple:
    """
    Where pairs of moving bodies come nearest.

    Args:
        bodies: points (k, 3) of each convex piece of each body, in its frame [m].
        poses: (bodies, n, 4, 4) of the bodies' frames in one frame, in n postures.
        pairs: (m, 2) numbers of bodies.
        limit: distances [m] from here on are not told apart.
    Returns: (m,) smallest signed distances [m] as `hull_distances` gives them, the limit where none is below, and (m,)
        numbers of the postures where they occur.
    Raises: ValueError for wrong shapes, numbers or values that are not finite.
    """

def potential_energy(
    model: Model,
    base_pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    s: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
) -> float:
    """
    [J], zero with the center of mass at height 0 of the world.
    """

def simulate_flight(
    model: Model,
    settings: FlightSettings,
    plant: collections.abc.Callable[[PlantInputs, float, RobotState], RobotState] | None = None,
) -> FlightLog:
    """
    Fly the model along the settings' trajectory. The model must have been loaded with joints=settings.joints. A lost flight is a status of the log. plant: a robot of your own, another simulator say, called once per period of the torque loop with the inputs held over it, the period [s] and the state; it returns the state at its end. Controllers and jets stay the flight's; masses, drag, friction and fuel are the plant's own, and what it raises ends the flight. Raises ValueError if model and settings do not fit each other, or for a plant under the predictive controller.
    """

def simulate_flights(
    model: Model, settings: FlightSettings, seeds: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex]
) -> list[FlightLog]:
    """
    The same flight once for every seed of its disturbances, one log each; as simulate_flight otherwise.
    """

def solve_box_qp(
    H: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]", "flags.f_contiguous"],
    g: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    lower: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
    upper: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
) -> BoxQpResult:
    """
    Minimize 0.5 x'Hx + g'x with lower <= x <= upper; H (n, n) symmetric positive definite, bounds may be infinite or equal. Raises ValueError on wrong sizes, NaN, an asymmetric H or crossed bounds; everything else is a status of the result.
    """

def trim_hover(
    model: Model,
    actuators: collections.abc.Sequence[Actuator],
    base_pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 4]"],
    joints: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
    *,
    moving: collections.abc.Sequence[str],
    joint_lower: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
    joint_upper: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
    tilt_weight: typing.SupportsFloat | typing.SupportsIndex = 3.0,
    thrust_weight: typing.SupportsFloat | typing.SupportsIndex = 0.003,
) -> Trim:
    """
    The hover nearest to a wanted state: base attitude, angles of the joints named in `moving` and thrusts that carry the weight without a moment, to 1e-9 N and N m. Least is sum(ds^2) + (tilt_weight tilt)^2 + sum((thrust_weight (T - mean T))^2). joints, joint_lower, joint_upper: (joints,) of the model [rad]. Raises ValueError for what does not fit.
    """

MAX_URDF_BYTES: int = 67108864
