#include "bindings/own_plant.hpp"

#include <pybind11/eigen.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace py = pybind11;

namespace codesign {

using namespace dynamics;

namespace {

RobotState robot_state(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& position,
                       Eigen::VectorXd joints, Eigen::VectorXd velocity) {
  return {Pose{rotation, position}, std::move(joints), std::move(velocity)};
}

}  // namespace

OwnPlant own_plant(PythonPlant plant) {
  return [plant = std::move(plant)](const PlantInputs& inputs, double duration, RobotState& state) {
    RobotState moved = plant(inputs, duration, state);
    if (moved.joints.size() != state.joints.size() ||
        moved.velocity.size() != state.velocity.size()) {
      throw std::invalid_argument(
          "simulate_flight: the plant returned " + std::to_string(moved.joints.size()) +
          " joint positions and " + std::to_string(moved.velocity.size()) + " velocities, not " +
          std::to_string(state.joints.size()) + " and " + std::to_string(state.velocity.size()));
    }
    state = std::move(moved);
  };
}

void bind_own_plant(py::module_& m) {
  py::class_<RobotState>(m, "RobotState",
                         "Of a floating-base robot: base velocity is that of the base's origin, "
                         "world axes, then its angular velocity, world axes.")
      .def(py::init(&robot_state), py::kw_only(), py::arg("base_rotation"),
           py::arg("base_position"), py::arg("joints"), py::arg("velocity"),
           "base_rotation (3, 3), base_position (3,) [m], joints (n,) [rad or m], velocity (6 + "
           "n,) [m/s, rad/s].")
      .def_property_readonly(
          "base_rotation", [](const RobotState& s) { return s.base.R; },
          "(3, 3) from base to world axes")
      .def_property_readonly(
          "base_position", [](const RobotState& s) { return s.base.p; }, "(3,) [m]")
      .def_readonly("joints", &RobotState::joints, "(n,) [rad or m]")
      .def_readonly("velocity", &RobotState::velocity, "(6 + n,) [m/s, rad/s]");
  py::class_<PlantInputs>(m, "PlantInputs", "What acts on the robot over one period, held.")
      .def_readonly("torque", &PlantInputs::torque, "(joints,) [N m]")
      .def_readonly("thrust", &PlantInputs::thrust, "(jets,) [N]")
      .def_readonly("base_force", &PlantInputs::base_force,
                    "(3,) gusts, on the base's origin, world axes [N]")
      .def_readonly("com_force", &PlantInputs::com_force,
                    "(3,) pulses, through the center of mass, world axes [N]")
      .def_readonly("base_moment", &PlantInputs::base_moment, "(3,) on the base, world axes [N m]");
}

}  // namespace codesign
