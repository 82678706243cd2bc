#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "bindings/bindings.hpp"
#include "bindings/py_model.hpp"
#include "dynamics/trim.hpp"

namespace py = pybind11;
using py::literals::operator""_a;

namespace codesign {

using namespace dynamics;

namespace {

Pose to_pose(const Eigen::Matrix4d& T) {
  if (!T.allFinite() || rotation_error(T.topLeftCorner<3, 3>()) > 1e-9) {
    throw std::invalid_argument("trim_hover: base_pose is not a rigid pose (rotation within 1e-9)");
  }
  return {T.topLeftCorner<3, 3>(), T.topRightCorner<3, 1>()};
}

Trim trim(const PyModel& model, const std::vector<Actuator>& actuators,
          const Eigen::Matrix4d& base_pose, const Eigen::VectorXd& joints,
          std::vector<std::string> moving, const Eigen::VectorXd& joint_lower,
          const Eigen::VectorXd& joint_upper, double tilt_weight, double thrust_weight) {
  TrimSettings settings;
  settings.joints = std::move(moving);
  settings.tilt_weight = tilt_weight;
  settings.thrust_weight = thrust_weight;
  return trim_hover(model, actuators, to_pose(base_pose), joints, {joint_lower, joint_upper},
                    settings);
}

}  // namespace

void bind_trim(py::module_& m) {
  py::class_<Trim>(m, "Trim", "A state in which a robot hovers, or how near one came to it.")
      .def_property_readonly(
          "base_pose",
          [](const Trim& trim) {
            Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
            T.topLeftCorner<3, 3>() = trim.base.R;
            T.topRightCorner<3, 1>() = trim.base.p;
            return T;
          },
          "(4, 4)")
      .def_readonly("joints", &Trim::joints, "(joints,) inside their ranges [rad]")
      .def_readonly("thrusts", &Trim::thrusts, "(actuators,) inside their ranges [N]")
      .def_readonly("residual", &Trim::residual,
                    "largest entry of the force and moment left over [N, N m]")
      .def_readonly("iterations", &Trim::iterations, "that it took")
      .def_readonly("reached", &Trim::reached, "whether the residual is within 1e-9");
  const TrimSettings defaults;
  m.def(
      "trim_hover", &trim, "model"_a, "actuators"_a, "base_pose"_a, "joints"_a, py::kw_only(),
      "moving"_a, "joint_lower"_a, "joint_upper"_a, "tilt_weight"_a = defaults.tilt_weight,
      "thrust_weight"_a = defaults.thrust_weight,
      "The hover nearest to a wanted state: base attitude, angles of the joints named in `moving` "
      "and thrusts that carry the weight without a moment, to 1e-9 N and N m. Least is sum(ds^2) "
      "+ (tilt_weight tilt)^2 + sum((thrust_weight (T - mean T))^2). joints, joint_lower, "
      "joint_upper: (joints,) of the model [rad]. Raises ValueError for what does not fit.");
}

}  // namespace codesign
