#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "bindings/bindings.hpp"
#include "bindings/keywords.hpp"
#include "bindings/py_model.hpp"
#include "dynamics/flight_settings.hpp"
#include "dynamics/predictive/predictive_controller.hpp"
#include "dynamics/predictive/servo_plant.hpp"

namespace py = pybind11;

namespace codesign {

using namespace dynamics;

namespace {

void bind_path(py::module_& m) {
  py::enum_<WaypointKind>(m, "WaypointKind", "How a path goes through its way-points.")
      .value("stop", WaypointKind::kStop, "at rest in each: minimum-jerk legs")
      .value("through", WaypointKind::kThrough, "least squared jerk, at rest at both ends");
  py::class_<Waypoint> waypoint(m, "Waypoint", "A point of a path, relative to its start.");
  bind_keywords(waypoint);
  waypoint.def_readwrite("position", &Waypoint::position, "(3,) world axes [m]")
      .def_readwrite("yaw", &Waypoint::yaw, "[rad]")
      .def_readwrite("duration", &Waypoint::duration, "to get there [s]")
      .def_readwrite("rest", &Waypoint::rest, "there [s]");
  py::class_<WaypointPath> path(m, "WaypointPath", "A path through way-points.");
  bind_keywords(path);
  path.def_readwrite("start", &WaypointPath::start, "time at the start position [s]")
      .def_readwrite("waypoints", &WaypointPath::waypoints, "list of Waypoint")
      .def_readwrite("kind", &WaypointPath::kind, "WaypointKind");
  py::class_<PathPoint>(m, "PathPoint", "Position (x, y, z) and yaw of a path, derivatives.")
      .def_readonly("value", &PathPoint::value, "(4,) [m, rad]")
      .def_readonly("velocity", &PathPoint::velocity, "(4,) [m/s, rad/s]")
      .def_readonly("acceleration", &PathPoint::acceleration, "(4,) [m/s^2, rad/s^2]")
      .def_readonly("jerk", &PathPoint::jerk, "(4,) [m/s^3, rad/s^3]");
  py::class_<Path>(m, "Path", "A path as functions of time; after its end it holds.")
      .def(py::init<const WaypointPath&>(), py::arg("path"))
      .def("at", &Path::at, py::arg("time"), "PathPoint at a time [s].")
      .def_property_readonly("end", &Path::end, "[s]")
      .def_property_readonly("peak_speed", &Path::peak_speed, "[m/s]")
      .def_property_readonly("peak_acceleration", &Path::peak_acceleration, "[m/s^2]");
  py::class_<Pulse> pulse(m, "Pulse",
                          "Force on the base through the center of mass, and moment on the base.");
  bind_keywords(pulse);
  pulse.def_readwrite("start", &Pulse::start, "[s]")
      .def_readwrite("duration", &Pulse::duration, "[s]")
      .def_readwrite("force", &Pulse::force, "(3,) world axes [N]")
      .def_readwrite("moment", &Pulse::moment, "(3,) world axes [N m]");
}

void bind_jet(py::module_& m) {
  py::class_<StandardizedTurbine> turbine(m, "StandardizedTurbine",
                                          "Second-order jet identified in standardized variables "
                                          "T, D, U: T'' = thrust_scale (f + g v), "
                                          "v = U + B_UU U^2, f = c + K_T T + K_D D + K_TD T D + "
                                          "K_TT T^2 + K_DD D^2, g = B + B_T T + B_D D + B_TD T D + "
                                          "B_TT T^2 + B_DD D^2.");
  bind_keywords(turbine);
  using T = StandardizedTurbine;
  turbine.def_readwrite("thrust_mean", &T::thrust_mean, "[N]")
      .def_readwrite("thrust_scale", &T::thrust_scale, "[N]")
      .def_readwrite("throttle_mean", &T::throttle_mean, "[%]")
      .def_readwrite("throttle_scale", &T::throttle_scale, "[%]")
      .def_readwrite("c", &T::c)
      .def_readwrite("K_T", &T::K_T)
      .def_readwrite("K_D", &T::K_D)
      .def_readwrite("K_TD", &T::K_TD)
      .def_readwrite("K_TT", &T::K_TT)
      .def_readwrite("K_DD", &T::K_DD)
      .def_readwrite("B", &T::B)
      .def_readwrite("B_T", &T::B_T)
      .def_readwrite("B_D", &T::B_D)
      .def_readwrite("B_TD", &T::B_TD)
      .def_readwrite("B_TT", &T::B_TT)
      .def_readwrite("B_DD", &T::B_DD)
      .def_readwrite("B_UU", &T::B_UU)
      .def_readwrite("throttle_max", &T::throttle_max, "[%]")
      .def_readwrite("rate_gain", &T::rate_gain, "of a loop that follows a thrust rate [1/s]")
      .def("variable", &throttle_variable, py::arg("throttle"), "v of a throttle [%]")
      .def("throttle", &throttle_of_variable, py::arg("variable"), "[%] of v, within its range")
      .def("steady_variable", &steady_variable, py::arg("thrust"), "v that holds a thrust [N]");
}

void bind_weights(py::module_& m) {
  py::class_<PredictiveWeights> weights(m, "PredictiveWeights",
                                        "Weights of the prediction's cost.");
  bind_keywords(weights);
  using W = PredictiveWeights;
  weights.def_readwrite("com", &W::com, "(3,)")
      .def_readwrite("com_integral", &W::com_integral, "(3,)")
      .def_readwrite("linear_momentum", &W::linear_momentum, "(3,) axes of the body")
      .def_readwrite("attitude", &W::attitude, "(3,) roll, pitch, yaw")
      .def_readwrite("attitude_integral", &W::attitude_integral, "(3,)")
      .def_readwrite("angular_momentum", &W::angular_momentum, "(3,) axes of the body")
      .def_readwrite("joint_displacement", &W::joint_displacement, "[1/rad^2]")
      .def_readwrite("posture", &W::posture, "[1/rad^2]")
      .def_readwrite("throttle_first", &W::throttle_first,
                     "of the first block from the throttle that acts")
      .def_readwrite("throttle_change", &W::throttle_change, "between blocks");
}

void bind_predictive_settings(py::module_& m) {
  bind_weights(m);
  py::enum_<PredictiveIntegral>(m, "PredictiveIntegral", "Where integrals of errors start.")
      .value("restart", PredictiveIntegral::kRestart, "at the present error, as published")
      .value("accumulate", PredictiveIntegral::kAccumulate, "at the sum of all errors so far");
  py::class_<PredictiveModelOptions> model(m, "PredictiveModelOptions",
                                           "What the prediction knows.");
  bind_keywords(model);
  model
      .def_readwrite("gravity_coupling", &PredictiveModelOptions::gravity_coupling,
                     "gravity turns with the predicted attitude; published: False")
      .def_readwrite("jet_dynamics", &PredictiveModelOptions::jet_dynamics,
                     "False: thrust follows the throttle at once")
      .def_readwrite("varying", &PredictiveModelOptions::varying,
                     "False: the linearization of the first solve is kept");
  py::class_<PredictiveSettings> settings(m, "PredictiveSettings",
                                          "Multi-rate predictive control.");
  bind_keywords(settings);
  using S = PredictiveSettings;
  settings.def_readwrite("period", &S::period, "of solves and joint set points [s]")
      .def_readwrite("throttle_every", &S::throttle_every, "solves")
      .def_readwrite("small_steps", &S::small_steps, "adding up to large_step")
      .def_readwrite("large_steps", &S::large_steps, "how many follow")
      .def_readwrite("large_step", &S::large_step, "[s]")
      .def_readwrite("control_steps", &S::control_steps, "steps with joint inputs of their own")
      .def_readwrite("body", &S::body, "link whose attitude is controlled")
      .def_readwrite("joints", &S::joints, "names of the joints that are moved")
      .def_readwrite("joint_speed", &S::joint_speed, "largest [rad/s]; infinity: no bound")
      .def_readwrite("integral", &S::integral, "PredictiveIntegral")
      .def_readwrite("model", &S::model, "PredictiveModelOptions")
      .def_readwrite("weights", &S::weights, "PredictiveWeights");
}

void bind_plant_settings(py::module_& m) {
  py::class_<ServoSettings> servo(
      m, "ServoSettings",
      "Position servos: k_p (s* - s) - k_d s', k_d = passive + 2 ratio sqrt(k_p M_jj).");
  bind_keywords(servo);
  servo.def_readwrite("stiffness", &ServoSettings::stiffness, "(joints,) k_p [N m/rad]")
      .def_readwrite("damping_ratio", &ServoSettings::damping_ratio, "(joints,)")
      .def_readwrite("passive", &ServoSettings::passive, "(joints,) [N m s/rad]");
  py::enum_<ServoIntegrator>(m, "ServoIntegrator", "How a robot with servos is advanced.")
      .value("implicit", ServoIntegrator::kImplicit, "servos implicit, one mass matrix a step")
      .value("runge_kutta_4", ServoIntegrator::kRungeKutta4, "fourth order, robot and jets");
  py::class_<ServoPlantSettings> plant(m, "ServoPlantSettings", "A robot with position servos.");
  bind_keywords(plant);
  plant.def_readwrite("servo", &ServoPlantSettings::servo, "ServoSettings")
      .def_readwrite("integrator", &ServoPlantSettings::integrator, "ServoIntegrator")
      .def_readwrite("step", &ServoPlantSettings::step, "at most [s]");
  py::class_<FuelRate> fuel(m, "FuelRate", "Fuel of one jet: idle + per_newton T.");
  bind_keywords(fuel);
  fuel.def_readwrite("idle", &FuelRate::idle, "[kg/s]")
      .def_readwrite("per_newton", &FuelRate::per_newton, "[kg/s/N]");
}

Pose to_pose(const Eigen::Matrix4d& T) {
  return {T.topLeftCorner<3, 3>(), T.topRightCorner<3, 1>()};
}

// A controller with the scratch that its calls from Python need.
class PyController {
 public:
  PyController(const PyModel& model, const FlightSettings& settings)
      : model_(model),
        settings_(settings),
        terms_(model_, settings_.actuators),
        controller_(model_, settings_) {}

  void start(const Eigen::Matrix4d& base, const Eigen::VectorXd& joints,
             const Eigen::VectorXd& thrusts, const Eigen::VectorXd& set_points) {
    require_size("set_points", set_points, model_.joint_count());
    update(base, joints, Eigen::VectorXd::Zero(model_.dofs()), thrusts,
           Eigen::VectorXd::Zero(thrusts.size()));
    controller_.start(terms_, jets_, set_points);
  }

  QpStatus solve(int k, const Eigen::Matrix4d& base, const Eigen::VectorXd& joints,
                 const Eigen::VectorXd& velocity, const Eigen::VectorXd& thrusts,
                 const Eigen::VectorXd& thrust_rates) {
    update(base, joints, velocity, thrusts, thrust_rates);
    return controller_.solve(k, terms_, jets_);
  }

  PredictiveController& controller() { return controller_; }

 private:
  static void require_size(const char* name, const Eigen::VectorXd& value, Eigen::Index size) {
    if (value.size() != size || !value.allFinite()) {
      throw std::invalid_argument(std::string("PredictiveController: ") + name + " needs " +
                                  std::to_string(size) + " finite values");
    }
  }

  void update(const Eigen::Matrix4d& base, const Eigen::VectorXd& joints,
              const Eigen::VectorXd& velocity, const Eigen::VectorXd& thrusts,
              const Eigen::VectorXd& thrust_rates) {
    const auto jets = static_cast<Eigen::Index>(settings_.actuators.size());
    require_size("joints", joints, model_.joint_count());
    require_size("velocity", velocity, model_.dofs());
    require_size("thrusts", thrusts, jets);
    require_size("thrust_rates", thrust_rates, jets);
    update_terms(model_, {to_pose(base), joints, velocity}, terms_);
    jets_.clear();
    for (Eigen::Index i = 0; i < jets; ++i) jets_.push_back({thrusts[i], thrust_rates[i]});
  }

  Model model_;
  FlightSettings settings_;
  RobotTerms terms_;
  std::vector<ThrustState> jets_;
  PredictiveController controller_;
};

void bind_prediction(py::module_& m) {
  using P = PredictionModel;
  py::class_<JetPrediction>(m, "JetPrediction", "Linear jet of a prediction.")
      .def_readonly("constant", &JetPrediction::constant, "[N/s^2]")
      .def_readonly("per_thrust", &JetPrediction::per_thrust, "[1/s^2]")
      .def_readonly("per_rate", &JetPrediction::per_rate, "[1/s]")
      .def_readonly("per_variable", &JetPrediction::per_variable, "[N/s^2]")
      .def_readonly("static_gain", &JetPrediction::static_gain, "of thrust per v, held steady [N]")
      .def_readonly("thrust", &JetPrediction::thrust, "of the linearization [N]")
      .def_readonly("thrust_rate", &JetPrediction::thrust_rate, "of the linearization [N/s]")
      .def_readonly("variable", &JetPrediction::variable, "v of the linearization");
  py::class_<P>(m, "PredictionModel", "The robot as the predictive controller sees it; body axes.")
      .def_readonly("mass", &P::mass, "[kg]")
      .def_readonly("world_R_body", &P::world_R_body, "(3, 3)")
      .def_readonly("angular_velocity", &P::angular_velocity, "(3,) [rad/s]")
      .def_readonly("inertia", &P::inertia, "(3, 3) about the center of mass [kg m^2]")
      .def_readonly("rpy_rate", &P::rpy_rate,
                    "(3, 3) roll, pitch, yaw rates per angular momentum [1/(kg m^2)]")
      .def_readonly("rpy", &P::rpy, "(3,) of the linearization [rad]")
      .def_readonly("weight", &P::weight, "(3,) [N]")
      .def_readonly("weight_per_rpy", &P::weight_per_rpy, "(3, 3) [N/rad]")
      .def_readonly("force_of_thrust", &P::force_of_thrust, "(3, jets) [N/N]")
      .def_readonly("moment_of_thrust", &P::moment_of_thrust, "(3, jets) [N m/N]")
      .def_readonly("force_of_joint", &P::force_of_joint, "(3, joints) [N/rad]")
      .def_readonly("moment_of_joint", &P::moment_of_joint, "(3, joints) [N m/rad]")
      .def_readonly("jets", &P::jets, "list of JetPrediction");
  py::class_<PredictionState>(m, "PredictionState", "What a prediction starts from.")
      .def_readonly("com", &PredictionState::com, "(3,) world axes [m]")
      .def_readonly("linear_momentum", &PredictionState::linear_momentum, "(3,) body axes [kg m/s]")
      .def_readonly("rpy", &PredictionState::rpy, "(3,) of the body, unwrapped [rad]")
      .def_readonly("angular_momentum", &PredictionState::angular_momentum,
                    "(3,) body axes [kg m^2/s]")
      .def_readonly("thrust", &PredictionState::thrust, "(jets,) [N]")
      .def_readonly("thrust_rate", &PredictionState::thrust_rate, "(jets,) [N/s]")
      .def_readonly("com_integral", &PredictionState::com_integral, "(3,) of its error [m s]")
      .def_readonly("rpy_integral", &PredictionState::rpy_integral, "(3,) of its error [rad s]");
}

void bind_controller(py::module_& m) {
  py::class_<PyController>(m, "PredictiveController",
                           "Single solves of the predictive controller, to look into it.")
      .def(py::init<const PyModel&, const FlightSettings&>(), py::arg("model"), py::arg("settings"))
      .def("start", &PyController::start, py::arg("base_pose"), py::arg("joints"),
           py::arg("thrusts"), py::arg("set_points"),
           "Begin at a state at rest: its center of mass and attitude are the path's start, the "
           "set points home, the throttles those that hold the thrusts.")
      .def("solve", &PyController::solve, py::arg("k"), py::arg("base_pose"), py::arg("joints"),
           py::arg("velocity"), py::arg("thrusts"), py::arg("thrust_rates"),
           "The k-th solve, at time k period; moves set points and throttles if it is solved.")
      .def_property_readonly(
          "hessian", [](PyController& c) { return Eigen::MatrixXd(c.controller().qp().hessian()); },
          "(n, n) of the last solve")
      .def_property_readonly(
          "gradient",
          [](PyController& c) { return Eigen::VectorXd(c.controller().qp().gradient()); },
          "(n,) of the last solve")
      .def_property_readonly(
          "lower", [](PyController& c) { return c.controller().lower(); }, "(n,)")
      .def_property_readonly(
          "upper", [](PyController& c) { return c.controller().upper(); }, "(n,)")
      .def_property_readonly(
          "result", [](PyController& c) { return c.controller().result(); },
          "BoxQpResult of the last solve")
      .def_property_readonly(
          "joint_columns", [](PyController& c) { return c.controller().qp().grid().joint_columns; },
          "first unknown of each block of joint displacements")
      .def_property_readonly(
          "throttle_columns",
          [](PyController& c) { return c.controller().qp().grid().throttle_columns; },
          "first unknown of each block of throttle variables")
      .def_property_readonly(
          "step_ends",
          [](PyController& c) {
            std::vector<double> ends;
            for (const auto& step : c.controller().qp().grid().steps) ends.push_back(step.end);
            return ends;
          },
          "of the prediction's steps from the solve [s]")
      .def_property_readonly(
          "prediction", [](PyController& c) { return c.controller().prediction(); },
          "PredictionModel of the last solve")
      .def_property_readonly(
          "state", [](PyController& c) { return c.controller().state(); },
          "PredictionState of the last solve")
      .def_property_readonly(
          "set_points", [](PyController& c) { return c.controller().set_points(); },
          "(joints,) [rad]")
      .def_property_readonly(
          "throttles", [](PyController& c) { return c.controller().throttles(); }, "[%]")
      .def_property_readonly(
          "variables", [](PyController& c) { return c.controller().variables(); },
          "(jets,) v of the throttles");
}

}  // namespace

void bind_predictive(py::module_& m) {
  py::enum_<Controller>(m, "Controller", "What flies the robot.")
      .value("momentum_qp", Controller::kMomentumQp, "momentum and torque QPs")
      .value("predictive", Controller::kPredictive, "multi-rate predictive control, servos");
  bind_path(m);
  bind_jet(m);
  bind_predictive_settings(m);
  bind_plant_settings(m);
}

void bind_predictive_controller(py::module_& m) {
  bind_prediction(m);
  bind_controller(m);
}

}  // namespace codesign
