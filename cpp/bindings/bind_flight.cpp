#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <tuple>

#include "bindings/bind_flight_settings.hpp"
#include "bindings/bindings.hpp"
#include "bindings/own_plant.hpp"
#include "bindings/py_model.hpp"
#include "dynamics/flight/flight.hpp"
#include "dynamics/flight/flight_start.hpp"
#include "dynamics/qp/box_qp.hpp"

namespace py = pybind11;

namespace codesign {

using namespace dynamics;

namespace {

using Matrix = Eigen::Ref<const Eigen::MatrixXd>;
using Vector = Eigen::Ref<const Eigen::VectorXd>;

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
      .def_readonly("status", &BoxQpResult::status, "QpStatus")
      .def_readonly("x", &BoxQpResult::x, "(n,) the minimizer")
      .def_readonly("multipliers", &BoxQpResult::multipliers,
                    "(n,) H x + g at the solution: >= 0 where x is at its lower bound, <= 0 at its "
                    "upper, 0 elsewhere")
      .def_readonly("iterations", &BoxQpResult::iterations, "Cholesky factorizations")
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
      "Minimize 0.5 x'Hx + g'x with lower <= x <= upper; H (n, n) symmetric positive definite, "
      "bounds may be infinite or equal. Raises ValueError on wrong sizes, NaN, an asymmetric H or "
      "crossed bounds; everything else is a status of the result.");
  py::class_<BoxQpSolver>(m, "BoxQpSolver",
                          "Box QP solver of one size that starts from its last working set.")
      .def(py::init<int>(), py::arg("size"))
      .def("solve", &solve_checked, py::arg("H"), py::arg("g"), py::arg("lower"), py::arg("upper"),
           "As solve_box_qp, warm-started from the last call.")
      .def("reset", &BoxQpSolver::reset, "Forget the last working set.")
      .def_property_readonly("size", &BoxQpSolver::size, "largest number of unknowns");
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
                             "(N, 6) linear, angular about the center of mass");
  bind_history<&L::momentum_error>(log, "momentum_error", Shape::kRows, "(N, 6) E_l, E_w");
  bind_history<&L::unmodeled_force>(log, "unmodeled_force", Shape::kRows,
                                    "(N, 6) force and moment about the center of mass that the "
                                    "momentum observer estimates [N, N m]; 0 without observer");
  bind_history<&L::thrust>(log, "thrust", Shape::kRows, "(N, jets) [N]");
  bind_history<&L::thrust_rate_command>(log, "thrust_rate_command", Shape::kRows,
                                        "(N, jets) [N/s]");
  bind_history<&L::thrust_command>(log, "thrust_command", Shape::kRows,
                                   "(N, jets) a rate [N/s], a thrust [N] or a throttle [%]");
  bind_history<&L::joint_velocity_command>(log, "joint_velocity_command", Shape::kRows,
                                           "(N, joints) [rad/s]");
  bind_history<&L::torque>(log, "torque", Shape::kRows, "(N, joints) [Nm]");
  bind_history<&L::wind>(log, "wind", Shape::kRows, "(N, 3) force on the base's origin [N]");
  bind_history<&L::clearance>(log, "clearance", Shape::kSeries,
                              "(N,) lowest contact point above the ground [m]");
  bind_history<&L::qp_iterations>(
      log, "qp_iterations", Shape::kRows,
      "(N, 2) linear systems solved for the momentum and the torque QP");
  bind_history<&L::active_bounds>(log, "active_bounds", Shape::kSeries, "(N,) of the momentum QP");
}

std::optional<std::string> reason_text(const FlightLog& log) {
  switch (log.failure_reason) {
    case FailureReason::kNotFailed:
      return std::nullopt;
    case FailureReason::kNoHover:
      return "no hover near the initial state";
    case FailureReason::kNoFuel:
      return "the tank is empty";
    case FailureReason::kMomentumQp:
      return "momentum QP not solved";
    case FailureReason::kTorqueQp:
      return "torque QP not solved";
    case FailureReason::kSingularMass:
      return "mass matrix is singular";
    case FailureReason::kNotFinite:
      return "a value is not finite";
    case FailureReason::kComError:
      return "center of mass too far from its reference";
    case FailureReason::kAttitudeError:
      return "attitude too far from its reference";
    case FailureReason::kJointSpeed:
      return "a joint is too fast";
  }
  return std::nullopt;
}

void bind_measures(py::module_& m) {
  using M = FlightMeasures;
  py::class_<M>(m, "FlightMeasures", "Tracking, energy and fuel of a flight.")
      .def_readonly("com_error_rms", &M::com_error_rms, "[m]")
      .def_readonly("attitude_error_rms", &M::attitude_error_rms,
                    "of the norm of the roll, pitch and yaw errors [rad]")
      .def_readonly("pose_error_rms", &M::pose_error_rms,
                    "of sqrt(|center of mass error|^2 + (1 m angle)^2) [m]")
      .def_readonly("max_com_error", &M::max_com_error, "[m]")
      .def_readonly("max_attitude_error", &M::max_attitude_error,
                    "norm of the roll, pitch and yaw errors [rad]")
      .def_readonly("final_com_error", &M::final_com_error, "[m]")
      .def_readonly("mechanical_energy", &M::mechanical_energy,
                    "sum over the joints of the integral of |torque velocity| [J]")
      .def_readonly("positive_energy", &M::positive_energy, "of its positive part [J]")
      .def_readonly("fuel", &M::fuel, "[kg]")
      .def_readonly("hover_margin", &M::hover_margin,
                    "1 - largest share of its limit that an initial thrust takes")
      .def_readonly("thrust_impulse", &M::thrust_impulse, "[N s]")
      .def_readonly("peak_torque", &M::peak_torque, "(joints,) [N m]")
      .def_readonly("peak_speed", &M::peak_speed, "(joints,) [rad/s]")
      .def_readonly("peak_power", &M::peak_power, "(joints,) [W]");
}

void bind_log(py::module_& m) {
  py::enum_<FlightStatus>(m, "FlightStatus", "Whether the flight reached its end.")
      .value("completed", FlightStatus::kCompleted)
      .value("failed", FlightStatus::kFailed);
  py::class_<FlightObjectives>(m, "FlightObjectives", "One family of objectives, to be minimized.")
      .def_readonly("momentum", &FlightObjectives::momentum,
                    "of linear and angular momentum error; units of the family, docs/flight.md")
      .def_readonly("joint_velocity", &FlightObjectives::joint_velocity,
                    "of velocity minus command, groups weighted; units of the family")
      .def_readonly("thrust", &FlightObjectives::thrust, "mean total thrust [N]");
  py::class_<ObjectiveParts>(m, "ObjectiveParts", "Terms of a family before they are added.")
      .def_readonly("linear_momentum", &ObjectiveParts::linear_momentum,
                    "units of the family; rms: [kg m/s]")
      .def_readonly("angular_momentum", &ObjectiveParts::angular_momentum,
                    "units of the family; rms: [kg m^2/s]")
      .def_readonly("joint_velocity", &ObjectiveParts::joint_velocity,
                    "one per joint group, without its weight");
  py::class_<FlightProfile>(m, "FlightProfile", "Wall time of a flight by phase of the step [s].")
      .def_readonly("plant", &FlightProfile::plant, "integration, jets")
      .def_readonly("terms", &FlightProfile::terms,
                    "kinematics, inertias, mass matrix and its factorization, Jacobians")
      .def_readonly("task", &FlightProfile::task, "references, building of the momentum QP")
      .def_readonly("momentum_qp", &FlightProfile::momentum_qp, "solution of the momentum QP")
      .def_readonly("torque", &FlightProfile::torque, "torque QP and rate limiter")
      .def_readonly("log", &FlightProfile::log, "checks and histories");
  bind_measures(m);
  py::class_<FlightLog> log(m, "FlightLog",
                            "What happened in a flight: histories (read-only arrays that share the "
                            "log's memory), status and summary. SI units, world axes.");
  bind_histories(log);
  log.def_readonly("samples", &FlightLog::samples, "N, how many there are")
      .def_readonly("step", &FlightLog::step, "between samples [s]")
      .def_readonly("status", &FlightLog::status, "FlightStatus")
      .def_property_readonly(
          "completed", [](const FlightLog& l) { return l.status == FlightStatus::kCompleted; },
          "whether the status says so")
      .def_property_readonly("failure_reason", &reason_text, "text, or None")
      .def_property_readonly(
          "failure_time",
          [](const FlightLog& l) {
            return l.status == FlightStatus::kFailed ? std::optional<double>(l.failure_time)
                                                     : std::nullopt;
          },
          "[s], or None")
      .def_readonly("ground_touched", &FlightLog::ground_touched,
                    "whether a contact point was below the ground")
      .def_readonly("max_com_error", &FlightLog::max_com_error, "[m]")
      .def_readonly("max_attitude_error", &FlightLog::max_attitude_error, "[rad]")
      .def_readonly("min_thrust", &FlightLog::min_thrust, "[N]")
      .def_readonly("max_thrust", &FlightLog::max_thrust, "[N]")
      .def_readonly("max_torque", &FlightLog::max_torque, "[Nm]")
      .def_readonly("max_joint_speed", &FlightLog::max_joint_speed, "[rad/s]")
      .def_readonly("min_clearance", &FlightLog::min_clearance, "[m]")
      .def_readonly("fuel_burnt", &FlightLog::fuel_burnt, "[kg]")
      .def_readonly("qp_failures", &FlightLog::qp_failures, "steps in which a QP was not solved")
      .def_readonly("total_qp_iterations", &FlightLog::total_qp_iterations,
                    "linear systems solved for both QPs")
      .def_readonly("profile", &FlightLog::profile, "FlightProfile")
      .def_readonly("rms", &FlightLog::rms, "FlightObjectives: root mean squares, SI")
      .def_readonly("script", &FlightLog::script,
                    "FlightObjectives as the authors' program prints them")
      .def_readonly("paper", &FlightLog::paper, "FlightObjectives as the paper defines them")
      .def_readonly("rms_parts", &FlightLog::rms_parts, "terms of rms")
      .def_readonly("script_parts", &FlightLog::script_parts, "terms of script")
      .def_readonly("measures", &FlightLog::measures, "FlightMeasures");
}

}  // namespace

void bind_flight(py::module_& m) {
  bind_box_qp(m);
  bind_flight_settings(m);
  bind_log(m);
  bind_own_plant(m);
  m.def(
      "simulate_flight",
      [](const PyModel& model, const FlightSettings& settings,
         const std::optional<PythonPlant>& plant) {
        const FlightSettings copy = settings;  // Python may change its own while the GIL is free
        const OwnPlant own = plant ? own_plant(*plant) : OwnPlant();
        const py::gil_scoped_release release;
        return simulate_flight(model, copy, own);
      },
      py::arg("model"), py::arg("settings"), py::arg("plant") = py::none(),
      "Fly the model along the settings' trajectory. The model must have been loaded with "
      "joints=settings.joints. A lost flight is a status of the log. plant: a robot of your own, "
      "another simulator say, called once per period of the torque loop with the inputs held over "
      "it, the period [s] and the state; it returns the state at its end. Controllers and jets "
      "stay "
      "the flight's; masses, drag, friction and fuel are the plant's own, and what it raises ends "
      "the flight. Raises ValueError if model and settings do not fit each other, or for a plant "
      "under the predictive controller.");
  m.def(
      "fitted_settings",
      [](const PyModel& model, const FlightSettings& settings) {
        FlightSettings result = fitted(model, settings);
        const FlightStart start = flight_start(model, result);
        result.base_pose.topLeftCorner<3, 3>() = start.state.base.R;
        result.base_pose.topRightCorner<3, 1>() = start.state.base.p;
        result.initial_joints = start.state.joints;
        result.initial_thrusts = start.thrusts;
        return result;
      },
      py::arg("model"), py::arg("settings"),
      "The settings with what they leave to the model: its joint ranges where they give none, and "
      "the state that the flight starts in where it is a trimmed hover. Raises ValueError if model "
      "and settings do not fit each other.");
  m.def(
      "simulate_flights",
      [](const PyModel& model, const FlightSettings& settings,
         const std::vector<std::uint64_t>& seeds) {
        const FlightSettings copy = settings;
        const py::gil_scoped_release release;
        return simulate_flights(model, copy, seeds);
      },
      py::arg("model"), py::arg("settings"), py::arg("seeds"),
      "The same flight once for every seed of its disturbances, one log each; as "
      "simulate_flight otherwise.");
  m.def(
      "momentum_qps",
      [](const PyModel& model, const FlightSettings& settings, const FlightLog& log, int every) {
        using Qp = std::tuple<Eigen::MatrixXd, Eigen::VectorXd, Eigen::VectorXd, Eigen::VectorXd>;
        std::vector<Qp> tuples;
        for (const MomentumQp& qp : momentum_qps(model, settings, log, every)) {
          tuples.emplace_back(qp.objective.hessian(), qp.objective.linear(), qp.lower, qp.upper);
        }
        return tuples;
      },
      py::arg("model"), py::arg("settings"), py::arg("log"), py::arg("every") = 1,
      "Momentum QPs (H, g, lower, upper) of samples 0, every, 2 every, ... of a flight, rebuilt "
      "from its log. Unknowns: thrust rates, then joint velocities. Raises ValueError if the log "
      "is not of this model and these settings.");
}

}  // namespace codesign
