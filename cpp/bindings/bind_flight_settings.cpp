#include "bindings/bind_flight_settings.hpp"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "bindings/keywords.hpp"
#include "dynamics/flight_settings.hpp"

namespace py = pybind11;

namespace codesign {

using namespace dynamics;

namespace {

void bind_reference_settings(py::module_& m) {
  py::enum_<Integrator>(m, "Integrator", "How the plant is advanced over a control step.")
      .value("euler", Integrator::kEuler, "explicit, the published one")
      .value("semi_implicit_euler", Integrator::kSemiImplicitEuler)
      .value("runge_kutta_4", Integrator::kRungeKutta4, "fourth order on the Lie group");

  py::class_<ContactPoint> contact(m, "ContactPoint", "A point monitored for ground contact.");
  bind_keywords(contact);
  contact.def_readwrite("frame", &ContactPoint::frame, "name")
      .def_readwrite("position", &ContactPoint::position, "(3,) in the frame [m]");

  py::class_<CommandWindow> window(
      m, "CommandWindow", "Pilot's command at samples with start < t < end; signs of the speeds.");
  bind_keywords(window);
  window.def_readwrite("start", &CommandWindow::start, "[s]")
      .def_readwrite("end", &CommandWindow::end, "[s]")
      .def_readwrite("front", &CommandWindow::front, "-1 to 1, of the speed")
      .def_readwrite("left", &CommandWindow::left, "-1 to 1, of the speed")
      .def_readwrite("up", &CommandWindow::up, "-1 to 1, of the speed")
      .def_readwrite("roll", &CommandWindow::roll, "-1 to 1, of the speed")
      .def_readwrite("pitch", &CommandWindow::pitch, "-1 to 1, of the speed")
      .def_readwrite("yaw", &CommandWindow::yaw, "-1 to 1, of the speed");

  py::class_<CommandSpeeds> speeds(m, "CommandSpeeds", "Change of the reference per second.");
  bind_keywords(speeds);
  speeds.def_readwrite("front", &CommandSpeeds::front, "[m/s]")
      .def_readwrite("left", &CommandSpeeds::left, "[m/s]")
      .def_readwrite("up", &CommandSpeeds::up, "[m/s]")
      .def_readwrite("roll", &CommandSpeeds::roll, "[rad/s]")
      .def_readwrite("pitch", &CommandSpeeds::pitch, "[rad/s]")
      .def_readwrite("yaw", &CommandSpeeds::yaw, "[rad/s]");

  py::class_<ReferenceSettings> reference(m, "ReferenceSettings", "From commands to references.");
  bind_keywords(reference);
  reference.def_readwrite("roll_min", &ReferenceSettings::roll_min, "[rad]")
      .def_readwrite("roll_max", &ReferenceSettings::roll_max, "[rad]")
      .def_readwrite("pitch_min", &ReferenceSettings::pitch_min, "[rad]")
      .def_readwrite("pitch_max", &ReferenceSettings::pitch_max, "[rad]")
      .def_readwrite("com_time", &ReferenceSettings::com_time, "[s]")
      .def_readwrite("jerk_time", &ReferenceSettings::jerk_time, "[s]")
      .def_readwrite("rotation_gain", &ReferenceSettings::rotation_gain, "[1/s]")
      .def_readwrite("angular_velocity_time", &ReferenceSettings::angular_velocity_time, "[s]");
}

void bind_control_settings(py::module_& m) {
  py::class_<Gains> gains(m, "Gains", "Gains of the momentum, attitude, posture and torque loops.");
  bind_keywords(gains);
  gains.def_readwrite("momentum_proportional", &Gains::momentum_proportional, "K_P")
      .def_readwrite("momentum_derivative", &Gains::momentum_derivative, "K_D")
      .def_readwrite("momentum_integral", &Gains::momentum_integral, "K_O, its inverse enters")
      .def_readwrite("attitude_proportional", &Gains::attitude_proportional, "c0")
      .def_readwrite("attitude_derivative", &Gains::attitude_derivative, "c1")
      .def_readwrite("posture", &Gains::posture, "(joints,) K_s [1/s]")
      .def_readwrite("torque_proportional", &Gains::torque_proportional, "k_P [1/s]")
      .def_readwrite("torque_integral", &Gains::torque_integral, "k_I [1/s^2]")
      .def_readwrite("observer", &Gains::observer, "of the momentum observer [1/s]; 0: none");

  py::class_<Weights> weights(m, "Weights", "Weights of the momentum QP and the torque QP.");
  bind_keywords(weights);
  weights.def_readwrite("momentum", &Weights::momentum, "of the momentum's squared error")
      .def_readwrite("constant_inertia", &Weights::constant_inertia,
                     "of the task that keeps the inertia constant")
      .def_readwrite("posture", &Weights::posture, "of the distance from the initial posture")
      .def_readwrite("joint_velocity", &Weights::joint_velocity, "of joint velocities")
      .def_readwrite("thrust_rate", &Weights::thrust_rate, "of thrust rates")
      .def_readwrite("thrust_symmetry", &Weights::thrust_symmetry,
                     "of differences within symmetry_pairs")
      .def_readwrite("regularization", &Weights::regularization,
                     "of everything, so that the solution is unique")
      .def_readwrite("torque", &Weights::torque, "of torques, in the torque QP");

  py::class_<Limits> limits(m, "Limits", "Ranges of joints, thrusts and torques.");
  bind_keywords(limits);
  limits
      .def_readwrite("joint_lower", &Limits::joint_lower,
                     "(joints,) [rad], before scaling; empty: the model's")
      .def_readwrite("joint_upper", &Limits::joint_upper,
                     "(joints,) [rad], before scaling; empty: the model's")
      .def_readwrite("joint_range_scale", &Limits::joint_range_scale, "(joints,)")
      .def_readwrite("joint_speed", &Limits::joint_speed, "[rad/s]")
      .def_readwrite("joint_slope", &Limits::joint_slope, "[1/rad]")
      .def_readwrite("thrust_slope", &Limits::thrust_slope, "[1/N]")
      .def_readwrite("torque", &Limits::torque, "[Nm]")
      .def_readwrite("torque_rate", &Limits::torque_rate, "[Nm/s]");

  py::class_<JointGroup> group(m, "JointGroup", "Joints of one term of the velocity objective.");
  bind_keywords(group);
  group.def_readwrite("name", &JointGroup::name, "of the group")
      .def_readwrite("joints", &JointGroup::joints, "names")
      .def_readwrite("weight", &JointGroup::weight, "of its velocity in the objective");

  py::class_<FailureLimits> failure(m, "FailureLimits", "The flight is lost beyond these.");
  bind_keywords(failure);
  failure.def_readwrite("com_error", &FailureLimits::com_error, "[m]")
      .def_readwrite("attitude_error", &FailureLimits::attitude_error, "[rad]")
      .def_readwrite("joint_speed", &FailureLimits::joint_speed, "[rad/s]");

  py::class_<Turbine> turbine(
      m, "Turbine",
      "Second-order jet: T'' = f + g (U + B_UU U^2), f = K_T T + K_TT T^2 + K_D T' + K_DD T'^2 + "
      "K_TD T T' + c, g = B_U + B_T T + B_D T'; thrust T [N], throttle U [%].");
  bind_keywords(turbine);
  turbine.def_readwrite("K_T", &Turbine::K_T)
      .def_readwrite("K_TT", &Turbine::K_TT)
      .def_readwrite("K_D", &Turbine::K_D)
      .def_readwrite("K_DD", &Turbine::K_DD)
      .def_readwrite("K_TD", &Turbine::K_TD)
      .def_readwrite("B_U", &Turbine::B_U)
      .def_readwrite("B_T", &Turbine::B_T)
      .def_readwrite("B_D", &Turbine::B_D)
      .def_readwrite("B_UU", &Turbine::B_UU)
      .def_readwrite("c", &Turbine::c)
      .def_readwrite("throttle_max", &Turbine::throttle_max, "[%]")
      .def_readwrite("rate_gain", &Turbine::rate_gain,
                     "of the feedback linearization that follows a thrust rate [1/s]");

  py::class_<RateIntegrator> integrator(m, "RateIntegrator", "Thrust follows the commanded rate.");
  bind_keywords(integrator);

  py::class_<FirstOrderLag> lag(
      m, "FirstOrderLag", "A propeller behind its speed controller: T' = (command - T) / time.");
  bind_keywords(lag);
  lag.def_readwrite("time", &FirstOrderLag::time, "[s]");

  py::class_<Actuator> actuator(
      m, "Actuator", "What pushes the robot along a line fixed in a frame: a jet, a propeller.");
  bind_keywords(actuator);
  actuator.def_readwrite("frame", &Actuator::frame, "name")
      .def_readwrite("axis", &Actuator::axis, "(3,) unit vector in the frame; thrust pushes along")
      .def_readwrite("reaction", &Actuator::reaction,
                     "moment about the axis per thrust, as of a propeller's drag [N m/N]")
      .def_readwrite("thrust_min", &Actuator::thrust_min, "[N]")
      .def_readwrite("thrust_max", &Actuator::thrust_max, "[N]")
      .def_readwrite("thrust_rate", &Actuator::thrust_rate, "largest [N/s]")
      .def_readwrite("dynamics", &Actuator::dynamics,
                     "RateIntegrator, FirstOrderLag, Turbine or StandardizedTurbine");

  py::class_<Disturbances> disturbances(m, "Disturbances", "What the controller does not know.");
  bind_keywords(disturbances);
  disturbances
      .def_readwrite("wind_force", &Disturbances::wind_force,
                     "(3,) on the base's origin, world axes [N]")
      .def_readwrite("wind_velocity", &Disturbances::wind_velocity,
                     "(3,) of the air that drags, world axes [m/s]")
      .def_readwrite("gust_deviation", &Disturbances::gust_deviation,
                     "(3,) standard deviation of the gusts [N]")
      .def_readwrite("gust_time", &Disturbances::gust_time, "correlation time [s]")
      .def_readwrite("mass_scale", &Disturbances::mass_scale, "plant's inertias over the model's")
      .def_readwrite("mass_deviation", &Disturbances::mass_deviation,
                     "relative standard deviation, drawn per body")
      .def_readwrite("thrust_scale", &Disturbances::thrust_scale,
                     "(jets,) plant's thrust over the jet's; empty: 1")
      .def_readwrite("thrust_deviation", &Disturbances::thrust_deviation,
                     "relative standard deviation, drawn per jet")
      .def_readwrite("seed", &Disturbances::seed, "of gusts and drawn deviations");
}

void bind_plant_settings(py::module_& m) {
  py::class_<TrimSettings> trim(m, "TrimSettings", "Which hover a flight starts in.");
  bind_keywords(trim);
  trim.def_readwrite("joints", &TrimSettings::joints, "names of those that may move")
      .def_readwrite("tilt_weight", &TrimSettings::tilt_weight, "[1/rad]")
      .def_readwrite("thrust_weight", &TrimSettings::thrust_weight, "[1/N]")
      .def_readwrite("largest_step", &TrimSettings::largest_step,
                     "of a joint in one iteration [rad, m]")
      .def_readwrite("tolerance", &TrimSettings::tolerance, "of the residual [N, N m]")
      .def_readwrite("iterations", &TrimSettings::iterations, "at most");

  py::class_<Friction> friction(
      m, "Friction",
      "Of the joints' drives, in the plant only: viscous s' + coulomb tanh(s' / slip_speed).");
  bind_keywords(friction);
  friction.def_readwrite("viscous", &Friction::viscous, "(joints,) [N m s/rad]; empty: none")
      .def_readwrite("coulomb", &Friction::coulomb, "(joints,) [N m]; empty: none")
      .def_readwrite("slip_speed", &Friction::slip_speed, "of the smooth sign [rad/s]");

  py::class_<Delays> delays(m, "Delays", "How late the robot gets what the controllers ask for.");
  bind_keywords(delays);
  delays
      .def_readwrite("momentum", &Delays::momentum,
                     "thrust rates and joint velocities; whole steps of the loop [s]")
      .def_readwrite("torque", &Delays::torque, "whole periods of the torque loop [s]")
      .def_readwrite("torque_lag", &Delays::torque_lag, "time constant of the drives [s]; 0: none");

  py::class_<DragArea> drag(m, "DragArea",
                            "What air drags: force -0.5 rho area |u| u, u against the air.");
  bind_keywords(drag);
  drag.def_readwrite("frame", &DragArea::frame, "name")
      .def_readwrite("position", &DragArea::position, "(3,) in the frame [m]")
      .def_readwrite("area", &DragArea::area, "C_d A [m^2]");

  py::class_<Tank> tank(m, "Tank",
                        "Fuel on board, part of its link's inertia at the start; the controller "
                        "does not see it go.");
  bind_keywords(tank);
  tank.def_readwrite("frame", &Tank::frame, "name")
      .def_readwrite("position", &Tank::position, "(3,) of the fuel, in the frame [m]")
      .def_readwrite("fuel", &Tank::fuel, "[kg]")
      .def_readwrite("consumption", &Tank::consumption, "[kg/(N s)]");
}

void bind_settings(py::module_& m) {
  py::class_<FlightSettings> settings(
      m, "FlightSettings",
      "Everything that decides a flight besides the robot; SI units. Vectors over joints have the "
      "order of `joints`, vectors over jets that of `actuators`. Assign lists and arrays whole.");
  bind_keywords(settings);
  settings
      .def_readwrite("step", &FlightSettings::step, "of the momentum loop, jets and samples [s]")
      .def_readwrite("duration", &FlightSettings::duration, "[s]")
      .def_readwrite("torque_updates", &FlightSettings::torque_updates,
                     "of the torque loop per step, evenly spaced")
      .def_readwrite("hold_inertia", &FlightSettings::hold_inertia,
                     "torque updates between two momentum QPs take the joint-space inertia of the "
                     "last momentum QP")
      .def_readwrite("integrator", &FlightSettings::integrator, "of the plant")
      .def_readwrite("substeps", &FlightSettings::substeps, "plant steps per torque update")
      .def_readwrite("rotation_deadband", &FlightSettings::rotation_deadband,
                     "base rotations of a plant step below this are dropped [rad]; published: 1e-6")
      .def_readwrite("joints", &FlightSettings::joints, "names")
      .def_readwrite("actuators", &FlightSettings::actuators, "list of Actuator")
      .def_readwrite("base_pose", &FlightSettings::base_pose, "(4, 4)")
      .def_readwrite("initial_joints", &FlightSettings::initial_joints, "(joints,) [rad]")
      .def_readwrite("initial_thrusts", &FlightSettings::initial_thrusts, "(jets,) [N]")
      .def_readwrite("initial_free_fall", &FlightSettings::initial_free_fall,
                     "first step without jets and torques, as published")
      .def_readwrite("trim", &FlightSettings::trim,
                     "TrimSettings: start in the hover nearest to the initial state; None: in it")
      .def_readwrite("posture_reference", &FlightSettings::posture_reference,
                     "(joints,) [rad]; empty: the angles at the start")
      .def_readwrite("rotor_inertia", &FlightSettings::rotor_inertia,
                     "(joints,) of the drives as their joints feel it [kg m^2]; empty: none")
      .def_readwrite("friction", &FlightSettings::friction, "of the joints' drives")
      .def_readwrite("delays", &FlightSettings::delays, "of what the controllers ask for")
      .def_readwrite("drag", &FlightSettings::drag, "list of DragArea")
      .def_readwrite("air_density", &FlightSettings::air_density, "[kg/m^3]")
      .def_readwrite("tank", &FlightSettings::tank, "Tank or None")
      .def_readwrite("command_speeds", &FlightSettings::command_speeds, "of full commands")
      .def_readwrite("trajectory", &FlightSettings::trajectory, "list of CommandWindow")
      .def_readwrite("reference", &FlightSettings::reference, "from commands to references")
      .def_readwrite("gains", &FlightSettings::gains, "of all loops")
      .def_readwrite("weights", &FlightSettings::weights, "of the QPs")
      .def_readwrite("limits", &FlightSettings::limits, "of joints, thrusts, torques")
      .def_readwrite("symmetry_pairs", &FlightSettings::symmetry_pairs, "pairs of jet indices")
      .def_readwrite("groups", &FlightSettings::groups, "list of JointGroup")
      .def_readwrite("contact_points", &FlightSettings::contact_points, "list of ContactPoint")
      .def_readwrite("ground_height", &FlightSettings::ground_height, "[m]")
      .def_readwrite("failure", &FlightSettings::failure, "where the flight is lost")
      .def_readwrite("disturbances", &FlightSettings::disturbances, "of the plant")
      .def_readwrite("controller", &FlightSettings::controller, "Controller")
      .def_readwrite("path", &FlightSettings::path, "replaces the commands if it has way-points")
      .def_readwrite("pulses", &FlightSettings::pulses, "list of Pulse")
      .def_readwrite("fuel", &FlightSettings::fuel, "of each jet")
      .def_readwrite("predictive", &FlightSettings::predictive, "of that controller")
      .def_readwrite("servo_plant", &FlightSettings::servo_plant, "of that controller's robot")
      .def(
          "validate", [](const FlightSettings& self) { validate(self); },
          "Raise ValueError naming the first attribute that is wrong.")
      .def_property_readonly("samples", &sample_count, "number of samples of the flight");
}

}  // namespace

void bind_flight_settings(py::module_& m) {
  bind_reference_settings(m);
  bind_control_settings(m);
  bind_plant_settings(m);
  bind_settings(m);
}

}  // namespace codesign
