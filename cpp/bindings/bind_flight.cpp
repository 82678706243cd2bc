#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>

#include "bindings/bindings.hpp"
#include "bindings/py_model.hpp"
#include "dynamics/box_qp.hpp"
#include "dynamics/flight.hpp"

namespace py = pybind11;

namespace codesign {

using namespace dynamics;

namespace {

using Matrix = Eigen::Ref<const Eigen::MatrixXd>;
using Vector = Eigen::Ref<const Eigen::VectorXd>;

// Keyword constructor: every keyword is an attribute, an unknown one is a TypeError.
template <typename Settings>
void bind_keywords(py::class_<Settings>& settings) {
  settings.def(py::init([](const py::kwargs& values) {
    auto result = std::make_unique<Settings>();
    const py::object self = py::cast(result.get(), py::return_value_policy::reference);
    for (const auto& [name, value] : values) {
      if (!py::hasattr(self, name)) {
        throw py::type_error(std::string(py::str(py::type::of(self).attr("__name__"))) +
                             " has no attribute '" + std::string(py::str(name)) + "'");
      }
      py::setattr(self, name, value);
    }
    return result;
  }));
}

// Arguments checked as a person needs them checked; the solver itself answers with a status.
BoxQpResult solve_checked(BoxQpSolver& solver, const Matrix& H, const Vector& g,
                          const Vector& lower, const Vector& upper) {
  const Eigen::Index n = solver.size();
  const auto refuse = [](const std::string& reason) {
    throw std::invalid_argument("solve_box_qp: " + reason);
  };
  if (H.rows() != n || H.cols() != n || g.size() != n || lower.size() != n || upper.size() != n) {
    refuse("H must be (n, n), g, lower and upper (n,), here n = " + std::to_string(n));
  }
  if (!H.allFinite() || !g.allFinite()) refuse("H or g has a value that is not finite");
  if ((H - H.transpose()).cwiseAbs().maxCoeff() > 1e-9 * H.cwiseAbs().maxCoeff()) {
    refuse("H is not symmetric");
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!(lower[i] <= upper[i])) {
      refuse("lower[" + std::to_string(i) + "] = " + std::to_string(lower[i]) +
             " is above upper = " + std::to_string(upper[i]));
    }
  }
  return solver.solve(H, g, lower, upper);
}

void bind_box_qp(py::module_& m) {
  py::enum_<QpStatus>(m, "QpStatus", "How a box QP ended.")
      .value("solved", QpStatus::kSolved, "KKT residual at most 1e-9")
      .value("iteration_limit", QpStatus::kIterationLimit, "best point found is returned")
      .value("not_positive_definite", QpStatus::kNotPositiveDefinite,
             "a Cholesky pivot of the free block is not positive")
      .value("bad_data", QpStatus::kBadData, "a value is not a number, or bounds are crossed");
  py::class_<BoxQpResult>(m, "BoxQpResult", "Solution of a box QP with its certificate.")
      .def_readonly("status", &BoxQpResult::status)
      .def_readonly("x", &BoxQpResult::x, "(n,) the minimiser")
      .def_readonly("multipliers", &BoxQpResult::multipliers,
                    "(n,) H x + g at the solution: >= 0 where x is at its lower bound, <= 0 at its "
                    "upper, 0 elsewhere")
      .def_readonly("iterations", &BoxQpResult::iterations, "Cholesky factorisations")
      .def_readonly("kkt_residual", &BoxQpResult::kkt_residual,
                    "largest violation of the optimality conditions, relative to the terms of the "
                    "gradient; independent of the variables' units");
  m.def(
      "solve_box_qp",
      [](const Matrix& H, const Vector& g, const Vector& lower, const Vector& upper) {
        if (g.size() < 1) throw std::invalid_argument("solve_box_qp: g is empty");
        BoxQpSolver solver(static_cast<int>(g.size()));
        return solve_checked(solver, H, g, lower, upper);
      },
      py::arg("H"), py::arg("g"), py::arg("lower"), py::arg("upper"),
      "Minimise 0.5 x'Hx + g'x with lower <= x <= upper; H (n, n) symmetric positive definite, "
      "bounds may be infinite or equal. Raises ValueError on wrong sizes, NaN, an asymmetric H or "
      "crossed bounds; everything else is a status of the result.");
  py::class_<BoxQpSolver>(m, "BoxQpSolver",
                          "Box QP solver of one size that starts from its last working set.")
      .def(py::init<int>(), py::arg("size"))
      .def("solve", &solve_checked, py::arg("H"), py::arg("g"), py::arg("lower"), py::arg("upper"),
           "As solve_box_qp, warm-started from the last call.")
      .def("reset", &BoxQpSolver::reset, "Forget the last working set.")
      .def_property_readonly("size", &BoxQpSolver::size);
}

void bind_settings(py::module_& m) {
  py::enum_<JetModel>(m, "JetModel", "Thrust dynamics of the jets.")
      .value("integrator", JetModel::kIntegrator, "thrust is the sum of the commanded rates")
      .value("turbine", JetModel::kTurbine, "second order, with throttle feedback linearisation");
  py::enum_<Integrator>(m, "Integrator", "How the plant is advanced over a control step.")
      .value("euler", Integrator::kEuler, "explicit, the published one")
      .value("semi_implicit_euler", Integrator::kSemiImplicitEuler)
      .value("runge_kutta_4", Integrator::kRungeKutta4, "fourth order on the Lie group");

  py::class_<ContactPoint> contact(m, "ContactPoint", "A point whose height is watched.");
  bind_keywords(contact);
  contact.def_readwrite("frame", &ContactPoint::frame)
      .def_readwrite("position", &ContactPoint::position, "(3,) in the frame [m]");

  py::class_<CommandWindow> window(
      m, "CommandWindow", "Pilot's command at samples with start < t < end; signs of the speeds.");
  bind_keywords(window);
  window.def_readwrite("start", &CommandWindow::start)
      .def_readwrite("end", &CommandWindow::end)
      .def_readwrite("front", &CommandWindow::front)
      .def_readwrite("left", &CommandWindow::left)
      .def_readwrite("up", &CommandWindow::up)
      .def_readwrite("roll", &CommandWindow::roll)
      .def_readwrite("pitch", &CommandWindow::pitch)
      .def_readwrite("yaw", &CommandWindow::yaw);

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
      .def_readwrite("turbine_rate", &Gains::turbine_rate, "[1/s]");

  py::class_<Weights> weights(m, "Weights", "Weights of the momentum QP and the torque QP.");
  bind_keywords(weights);
  weights.def_readwrite("momentum", &Weights::momentum)
      .def_readwrite("constant_inertia", &Weights::constant_inertia)
      .def_readwrite("posture", &Weights::posture)
      .def_readwrite("joint_velocity", &Weights::joint_velocity)
      .def_readwrite("thrust_rate", &Weights::thrust_rate)
      .def_readwrite("thrust_symmetry", &Weights::thrust_symmetry)
      .def_readwrite("regularisation", &Weights::regularisation)
      .def_readwrite("torque", &Weights::torque);

  py::class_<Limits> limits(m, "Limits", "Ranges of joints, thrusts and torques.");
  bind_keywords(limits);
  limits.def_readwrite("joint_lower", &Limits::joint_lower, "(joints,) [rad], before scaling")
      .def_readwrite("joint_upper", &Limits::joint_upper, "(joints,) [rad], before scaling")
      .def_readwrite("joint_range_scale", &Limits::joint_range_scale, "(joints,)")
      .def_readwrite("joint_speed", &Limits::joint_speed, "[rad/s]")
      .def_readwrite("joint_slope", &Limits::joint_slope, "[1/rad]")
      .def_readwrite("thrust_max", &Limits::thrust_max, "[N]")
      .def_readwrite("thrust_rate", &Limits::thrust_rate, "[N/s]")
      .def_readwrite("thrust_slope", &Limits::thrust_slope, "[1/N]")
      .def_readwrite("torque", &Limits::torque, "[Nm]")
      .def_readwrite("torque_rate", &Limits::torque_rate, "[Nm/s]");

  py::class_<JointGroup> group(m, "JointGroup", "Joints of one term of the velocity objective.");
  bind_keywords(group);
  group.def_readwrite("name", &JointGroup::name)
      .def_readwrite("joints", &JointGroup::joints)
      .def_readwrite("weight", &JointGroup::weight);

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
      .def_readwrite("throttle_max", &Turbine::throttle_max, "[%]");

  py::class_<Disturbances> disturbances(m, "Disturbances", "What the controller does not know.");
  bind_keywords(disturbances);
  disturbances
      .def_readwrite("wind_force", &Disturbances::wind_force,
                     "(3,) on the base's origin, world axes [N]")
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
      .def_readwrite("seed", &Disturbances::seed);
}

void bind_flight_settings(py::module_& m) {
  py::class_<FlightSettings> settings(
      m, "FlightSettings",
      "Everything that decides a flight besides the robot; SI units. Vectors over joints have the "
      "order of `joints`, vectors over jets that of `jets`. Assign lists and arrays whole.");
  bind_keywords(settings);
  settings.def_readwrite("step", &FlightSettings::step, "of the control loop [s]")
      .def_readwrite("duration", &FlightSettings::duration, "[s]")
      .def_readwrite("integrator", &FlightSettings::integrator)
      .def_readwrite("substeps", &FlightSettings::substeps, "plant steps per control step")
      .def_readwrite("joints", &FlightSettings::joints, "names")
      .def_readwrite("jets", &FlightSettings::jets, "frames; thrust pushes along their -z")
      .def_readwrite("base_pose", &FlightSettings::base_pose, "(4, 4)")
      .def_readwrite("initial_joints", &FlightSettings::initial_joints, "(joints,) [rad]")
      .def_readwrite("initial_thrusts", &FlightSettings::initial_thrusts, "(jets,) [N]")
      .def_readwrite("initial_free_fall", &FlightSettings::initial_free_fall,
                     "first step without jets and torques, as published")
      .def_readwrite("jet_model", &FlightSettings::jet_model)
      .def_readwrite("turbines", &FlightSettings::turbines, "one per jet")
      .def_readwrite("command_speeds", &FlightSettings::command_speeds)
      .def_readwrite("trajectory", &FlightSettings::trajectory, "list of CommandWindow")
      .def_readwrite("reference", &FlightSettings::reference)
      .def_readwrite("gains", &FlightSettings::gains)
      .def_readwrite("weights", &FlightSettings::weights)
      .def_readwrite("limits", &FlightSettings::limits)
      .def_readwrite("symmetry_pairs", &FlightSettings::symmetry_pairs, "pairs of jet indices")
      .def_readwrite("groups", &FlightSettings::groups, "list of JointGroup")
      .def_readwrite("contact_points", &FlightSettings::contact_points)
      .def_readwrite("ground_height", &FlightSettings::ground_height, "[m]")
      .def_readwrite("failure", &FlightSettings::failure)
      .def_readwrite("disturbances", &FlightSettings::disturbances)
      .def("validate", &validate, "Raise ValueError naming the first attribute that is wrong.")
      .def_property_readonly("samples", &sample_count, "number of samples of the flight");
}

// A history as an array that shares its memory with the log.
template <typename Array>
py::array view(const Array& history, const std::vector<py::ssize_t>& shape, const py::object& log) {
  py::array array(py::dtype::of<typename Array::Scalar>(), shape, history.data(), log);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

enum class Shape { kSeries, kRows, kRotations };

template <auto member>
void bind_history(py::class_<FlightLog>& log, const char* name, Shape shape, const char* doc) {
  log.def_property_readonly(
      name,
      [shape](const py::object& self) {
        const auto& history = self.cast<const FlightLog&>().*member;
        const py::ssize_t n = history.rows();
        if (shape == Shape::kSeries) return view(history, {n}, self);
        if (shape == Shape::kRotations) return view(history, {n, 3, 3}, self);
        return view(history, {n, static_cast<py::ssize_t>(history.cols())}, self);
      },
      doc);
}

void bind_histories(py::class_<FlightLog>& log) {
  using L = FlightLog;
  bind_history<&L::time>(log, "time", Shape::kSeries, "(N,) [s]");
  bind_history<&L::base_position>(log, "base_position", Shape::kRows, "(N, 3) [m]");
  bind_history<&L::base_rotation>(log, "base_rotation", Shape::kRotations,
                                  "(N, 3, 3) world_R_base");
  bind_history<&L::joint_positions>(log, "joint_positions", Shape::kRows, "(N, joints) [rad]");
  bind_history<&L::velocity>(log, "velocity", Shape::kRows, "(N, 6 + joints) mixed");
  bind_history<&L::com>(log, "com", Shape::kRows, "(N, 3) [m]");
  bind_history<&L::com_reference>(log, "com_reference", Shape::kRows, "(N, 3) [m]");
  bind_history<&L::com_velocity_reference>(log, "com_velocity_reference", Shape::kRows,
                                           "(N, 3) [m/s]");
  bind_history<&L::rotation_reference>(log, "rotation_reference", Shape::kRotations, "(N, 3, 3)");
  bind_history<&L::angular_velocity_reference>(log, "angular_velocity_reference", Shape::kRows,
                                               "(N, 3) base axes [rad/s]");
  bind_history<&L::momentum>(log, "momentum", Shape::kRows,
                             "(N, 6) linear, angular about the centre of mass");
  bind_history<&L::momentum_error>(log, "momentum_error", Shape::kRows, "(N, 6) E_l, E_w");
  bind_history<&L::thrust>(log, "thrust", Shape::kRows, "(N, jets) [N]");
  bind_history<&L::thrust_rate_command>(log, "thrust_rate_command", Shape::kRows,
                                        "(N, jets) [N/s]");
  bind_history<&L::throttle>(log, "throttle", Shape::kRows, "(N, jets) [%], turbine jets only");
  bind_history<&L::joint_velocity_command>(log, "joint_velocity_command", Shape::kRows,
                                           "(N, joints) [rad/s]");
  bind_history<&L::torque>(log, "torque", Shape::kRows, "(N, joints) [Nm]");
  bind_history<&L::wind>(log, "wind", Shape::kRows, "(N, 3) force on the base's origin [N]");
  bind_history<&L::clearance>(log, "clearance", Shape::kSeries,
                              "(N,) lowest contact point above the ground [m]");
  bind_history<&L::qp_iterations>(log, "qp_iterations", Shape::kRows,
                                  "(N, 2) factorisations of the momentum and the torque QP");
  bind_history<&L::active_bounds>(log, "active_bounds", Shape::kSeries, "(N,) of the momentum QP");
}

std::optional<std::string> reason_text(const FlightLog& log) {
  switch (log.failure_reason) {
    case FailureReason::kNotFailed:
      return std::nullopt;
    case FailureReason::kMomentumQp:
      return "momentum QP not solved";
    case FailureReason::kTorqueQp:
      return "torque QP not solved";
    case FailureReason::kSingularMass:
      return "mass matrix is singular";
    case FailureReason::kNotFinite:
      return "a value is not finite";
    case FailureReason::kComError:
      return "centre of mass too far from its reference";
    case FailureReason::kAttitudeError:
      return "attitude too far from its reference";
    case FailureReason::kJointSpeed:
      return "a joint is too fast";
  }
  return std::nullopt;
}

void bind_log(py::module_& m) {
  py::enum_<FlightStatus>(m, "FlightStatus", "Whether the flight reached its end.")
      .value("completed", FlightStatus::kCompleted)
      .value("failed", FlightStatus::kFailed);
  py::class_<FlightObjectives>(m, "FlightObjectives", "One family of objectives, to be minimised.")
      .def_readonly("momentum", &FlightObjectives::momentum)
      .def_readonly("joint_velocity", &FlightObjectives::joint_velocity)
      .def_readonly("thrust", &FlightObjectives::thrust, "mean total thrust [N]");
  py::class_<ObjectiveParts>(m, "ObjectiveParts", "Terms of a family before they are added.")
      .def_readonly("linear_momentum", &ObjectiveParts::linear_momentum)
      .def_readonly("angular_momentum", &ObjectiveParts::angular_momentum)
      .def_readonly("joint_velocity", &ObjectiveParts::joint_velocity,
                    "one per joint group, without its weight");
  py::class_<FlightLog> log(m, "FlightLog",
                            "What happened in a flight: histories (read-only arrays that share the "
                            "log's memory), status and summary. SI units, world axes.");
  bind_histories(log);
  log.def_readonly("samples", &FlightLog::samples)
      .def_readonly("step", &FlightLog::step)
      .def_readonly("status", &FlightLog::status)
      .def_property_readonly(
          "completed", [](const FlightLog& l) { return l.status == FlightStatus::kCompleted; })
      .def_property_readonly("failure_reason", &reason_text, "text, or None")
      .def_property_readonly(
          "failure_time",
          [](const FlightLog& l) {
            return l.status == FlightStatus::kFailed ? std::optional<double>(l.failure_time)
                                                     : std::nullopt;
          },
          "[s], or None")
      .def_readonly("ground_touched", &FlightLog::ground_touched)
      .def_readonly("max_com_error", &FlightLog::max_com_error, "[m]")
      .def_readonly("max_attitude_error", &FlightLog::max_attitude_error, "[rad]")
      .def_readonly("min_thrust", &FlightLog::min_thrust, "[N]")
      .def_readonly("max_thrust", &FlightLog::max_thrust, "[N]")
      .def_readonly("max_torque", &FlightLog::max_torque, "[Nm]")
      .def_readonly("max_joint_speed", &FlightLog::max_joint_speed, "[rad/s]")
      .def_readonly("min_clearance", &FlightLog::min_clearance, "[m]")
      .def_readonly("qp_failures", &FlightLog::qp_failures)
      .def_readonly("total_qp_iterations", &FlightLog::total_qp_iterations)
      .def_readonly("rms", &FlightLog::rms)
      .def_readonly("script", &FlightLog::script)
      .def_readonly("paper", &FlightLog::paper)
      .def_readonly("rms_parts", &FlightLog::rms_parts)
      .def_readonly("script_parts", &FlightLog::script_parts);
}

}  // namespace

void bind_flight(py::module_& m) {
  bind_box_qp(m);
  bind_settings(m);
  bind_control_settings(m);
  bind_flight_settings(m);
  bind_log(m);
  m.def(
      "simulate_flight",
      [](const PyModel& model, const FlightSettings& settings) {
        const FlightSettings copy = settings;  // Python may change its own while the GIL is free
        const py::gil_scoped_release release;
        return simulate_flight(model, copy);
      },
      py::arg("model"), py::arg("settings"),
      "Fly the model along the settings' trajectory. The model must have been loaded with "
      "joints=settings.joints. A lost flight is a status of the log. Raises ValueError if model "
      "and settings do not fit each other.");
}

}  // namespace codesign
