#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <vector>

#include "bindings/bindings.hpp"
#include "bindings/py_model.hpp"
#include "dynamics/centroidal.hpp"
#include "dynamics/urdf/urdf.hpp"
#include "dynamics/urdf/urdf_text.hpp"
#include "errors.hpp"

namespace py = pybind11;

namespace codesign {
namespace {

using dynamics::Pose;
using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
using VectorMap = Eigen::Map<const Eigen::VectorXd>;

std::string shape_of(const Array& array) {
  std::string text = "(";
  for (py::ssize_t i = 0; i < array.ndim(); ++i) {
    text += (i ? ", " : "") + std::to_string(array.shape(i));
  }
  return text + (array.ndim() == 1 ? ",)" : ")");
}

VectorMap vector(const std::string_view name, const Array& array, int size) {
  if (array.ndim() != 1 || array.shape(0) != size) {
    throw std::invalid_argument(std::string(name) + " must have shape (" + std::to_string(size) +
                                ",), got " + shape_of(array));
  }
  const VectorMap map(array.data(), size);
  if (!map.allFinite()) throw std::invalid_argument(std::string(name) + " must be finite");
  return map;
}

Pose pose(const Array& array) {
  if (array.ndim() != 2 || array.shape(0) != 4 || array.shape(1) != 4) {
    throw std::invalid_argument("base_pose must have shape (4, 4), got " + shape_of(array));
  }
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> T(array.data());
  if (!T.allFinite()) throw std::invalid_argument("base_pose must be finite");
  const Pose result{T.topLeftCorner<3, 3>(), T.topRightCorner<3, 1>()};
  constexpr double kTolerance = 1e-6;  // single-precision poses pass
  if (dynamics::rotation_error(result.R) > kTolerance ||
      T.row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)) {
    throw std::invalid_argument(
        "base_pose must be a rotation and a translation with last row (0, 0, 0, 1)");
  }
  return result;
}

// A new C-contiguous array: (rows, cols), or (rows,) for a column vector.
template <typename Derived>
Array to_array(const Eigen::MatrixBase<Derived>& m) {
  if constexpr (Derived::ColsAtCompileTime == 1) {
    Array result(m.size());
    Eigen::Map<Eigen::VectorXd>(result.mutable_data(), m.size()) = m;
    return result;
  } else {
    Array result({m.rows(), m.cols()});
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
        result.mutable_data(), m.rows(), m.cols()) = m;
    return result;
  }
}

void set_positions(const PyModel& model, const Array& base_pose, const Array& s) {
  dynamics::forward_kinematics(model, pose(base_pose), vector("s", s, model.joint_count()),
                               model.kin);
}

void set_inertias(const PyModel& model, const Array& base_pose, const Array& s) {
  set_positions(model, base_pose, s);
  dynamics::compute_inertias(model, model.kin, model.inertia);
}

void set_velocities(const PyModel& model, const Array& nu) {
  dynamics::forward_velocities(model, model.kin, vector("nu", nu, model.dofs()), model.velocity);
}

void set_state(const PyModel& model, const Array& base_pose, const Array& s, const Array& nu) {
  set_inertias(model, base_pose, s);
  set_velocities(model, nu);
}

// A new array (dofs,) and what Eigen writes into it.
struct NewVector {
  explicit NewVector(int size) : array(size), map(array.mutable_data(), size) {}
  Array array;
  Eigen::Map<Eigen::VectorXd> map;
};

Array mass_matrix(const PyModel& model, const Array& base_pose, const Array& s) {
  set_inertias(model, base_pose, s);
  Array result({model.dofs(), model.dofs()});
  Eigen::Map<Eigen::MatrixXd> M(result.mutable_data(), model.dofs(), model.dofs());
  dynamics::mass_matrix(model, model.kin, model.inertia, M);  // symmetric: either storage order
  return result;
}

Array bias_forces(const PyModel& model, const Array& base_pose, const Array& s, const Array& nu) {
  set_state(model, base_pose, s, nu);
  NewVector b(model.dofs());
  dynamics::bias_forces(model, model.kin, model.inertia, model.velocity, model.forces, b.map);
  return b.array;
}

Array gravity_forces(const PyModel& model, const Array& base_pose, const Array& s) {
  set_inertias(model, base_pose, s);
  NewVector g(model.dofs());
  dynamics::gravity_forces(model, model.kin, model.inertia, g.map);
  return g.array;
}

Array inverse_dynamics(const PyModel& model, const Array& base_pose, const Array& s,
                       const Array& nu, const Array& nu_dot) {
  set_state(model, base_pose, s, nu);
  NewVector forces(model.dofs());
  dynamics::inverse_dynamics(model, model.kin, model.inertia, model.velocity,
                             vector("nu_dot", nu_dot, model.dofs()), model.forces, forces.map);
  return forces.array;
}

Array forward_dynamics(const PyModel& model, const Array& base_pose, const Array& s,
                       const Array& nu, const Array& tau, const py::dict& wrenches) {
  model.wrenches.clear();
  for (const auto& [frame, wrench] : wrenches) {
    const auto name = frame.cast<std::string>();
    const int index = dynamics::frame_index(model, name);
    model.wrenches.push_back({index, vector("wrench on " + name, wrench.cast<Array>(), 6)});
  }
  set_state(model, base_pose, s, nu);
  NewVector nu_dot(model.dofs());
  dynamics::forward_dynamics(model, model.kin, model.inertia, model.velocity,
                             vector("tau", tau, model.joint_count()), model.wrenches,
                             model.articulated, nu_dot.map);
  if (!nu_dot.map.allFinite()) throw SolverError("the mass matrix is singular at this state");
  return nu_dot.array;
}

Array center_of_mass(const PyModel& model, const Array& base_pose, const Array& s) {
  set_inertias(model, base_pose, s);
  return to_array(dynamics::center_of_mass(model.kin, model.inertia));
}

Array center_of_mass_velocity(const PyModel& model, const Array& base_pose, const Array& s,
                              const Array& nu) {
  set_state(model, base_pose, s, nu);
  return to_array(
      dynamics::center_of_mass_velocity(model, model.kin, model.inertia, model.velocity));
}

Array center_of_mass_jacobian(const PyModel& model, const Array& base_pose, const Array& s) {
  set_inertias(model, base_pose, s);
  dynamics::center_of_mass_jacobian(model, model.kin, model.inertia, model.three_rows);
  return to_array(model.three_rows);
}

Array centroidal_momentum(const PyModel& model, const Array& base_pose, const Array& s,
                          const Array& nu) {
  set_state(model, base_pose, s, nu);
  return to_array(dynamics::centroidal_momentum(model, model.kin, model.inertia, model.velocity));
}

Array centroidal_momentum_matrix(const PyModel& model, const Array& base_pose, const Array& s) {
  set_inertias(model, base_pose, s);
  dynamics::centroidal_momentum_matrix(model, model.kin, model.inertia, model.six_rows);
  return to_array(model.six_rows);
}

Array centroidal_momentum_bias(const PyModel& model, const Array& base_pose, const Array& s,
                               const Array& nu) {
  set_state(model, base_pose, s, nu);
  return to_array(
      dynamics::centroidal_momentum_bias(model, model.kin, model.inertia, model.velocity));
}

Array locked_inertia(const PyModel& model, const Array& base_pose, const Array& s) {
  set_inertias(model, base_pose, s);
  return to_array(dynamics::locked_inertia(model.inertia));
}

double kinetic_energy(const PyModel& model, const Array& base_pose, const Array& s,
                      const Array& nu) {
  set_state(model, base_pose, s, nu);
  return dynamics::kinetic_energy(model, model.kin, model.inertia, model.velocity);
}

double potential_energy(const PyModel& model, const Array& base_pose, const Array& s) {
  set_inertias(model, base_pose, s);
  return dynamics::potential_energy(model.kin, model.inertia);
}

Array frame_pose(const PyModel& model, const Array& base_pose, const Array& s,
                 std::string_view frame) {
  const int index = dynamics::frame_index(model, frame);
  set_positions(model, base_pose, s);
  const Pose T = dynamics::frame_pose(model, model.kin, index);
  Eigen::Matrix4d result = Eigen::Matrix4d::Identity();
  result.topLeftCorner<3, 3>() = T.R;
  result.topRightCorner<3, 1>() = T.p;
  return to_array(result);
}

Array frame_jacobian(const PyModel& model, const Array& base_pose, const Array& s,
                     std::string_view frame) {
  const int index = dynamics::frame_index(model, frame);
  set_positions(model, base_pose, s);
  dynamics::frame_jacobian(model, model.kin, index, model.six_rows);
  return to_array(model.six_rows);
}

Array frame_velocity(const PyModel& model, const Array& base_pose, const Array& s, const Array& nu,
                     std::string_view frame) {
  const int index = dynamics::frame_index(model, frame);
  set_positions(model, base_pose, s);
  set_velocities(model, nu);
  return to_array(dynamics::frame_velocity(model, model.kin, model.velocity, index));
}

Array frame_bias_acceleration(const PyModel& model, const Array& base_pose, const Array& s,
                              const Array& nu, std::string_view frame) {
  const int index = dynamics::frame_index(model, frame);
  set_positions(model, base_pose, s);
  set_velocities(model, nu);
  return to_array(dynamics::frame_bias_acceleration(model, model.kin, model.velocity, index));
}

PyModel load_urdf(const py::object& text_or_path, std::optional<std::vector<std::string>> joints,
                  bool as_published, bool fixed_base) {
  const py::object source = py::module_::import("os").attr("fspath")(text_or_path);
  const auto text = source.cast<std::string>();
  const dynamics::UrdfOptions options{std::move(joints), as_published, fixed_base};
  const py::gil_scoped_release release;
  return PyModel(dynamics::load_urdf(text, options));
}

template <typename Named>
std::vector<std::string> names(const std::vector<Named>& items) {
  std::vector<std::string> result;
  result.reserve(items.size());
  for (const Named& item : items) result.push_back(item.name);
  return result;
}

py::dict joint_limits(const PyModel& model) {
  py::dict limits;
  for (const dynamics::Joint& joint : model.joints) {
    py::dict entry;
    entry["lower"] = joint.lower;
    entry["upper"] = joint.upper;
    entry["velocity"] = joint.velocity;
    entry["effort"] = joint.effort;
    limits[py::str(joint.name)] = entry;
  }
  return limits;
}

void bind_model(py::module_& m) {
  py::class_<PyModel>(m, "Model",
                      "A robot, made by load_urdf: joints that move, links as frames, masses.")
      .def_property_readonly(
          "joint_names", [](const PyModel& model) { return names(model.joints); },
          "Names of the joints that move, in the order of s and of the joint part of nu.")
      .def_property_readonly(
          "frame_names", [](const PyModel& model) { return names(model.frames); },
          "Names of all links, fixed and locked ones included, in the order of the URDF.")
      .def_property_readonly(
          "base_link", [](const PyModel& model) { return model.bodies.front().name; },
          "Name of the root link, whose pose is base_pose.")
      .def_property_readonly("joint_limits", &joint_limits,
                             "Name to lower, upper [rad, m], velocity and effort, as in the URDF. "
                             "For information: no function applies them.")
      .def_readonly("name", &PyModel::name, "Name of the robot.")
      .def_readonly("total_mass", &PyModel::total_mass, "Mass of all links [kg].")
      .def_readonly("fixed_base", &PyModel::fixed_base, "Whether the root link is held.")
      .def_property_readonly("dofs", &PyModel::dofs, "Length of nu: 6 + n, or n if fixed_base.")
      .def("__repr__", [](const PyModel& model) {
        return "<Model \"" + model.name + "\": " + std::to_string(model.joint_count()) +
               " joints, " + (model.fixed_base ? "fixed" : "floating") + " base, " +
               py::str(py::float_(model.total_mass)).cast<std::string>() + " kg>";
      });
  m.attr("MAX_URDF_BYTES") = dynamics::kMaxUrdfBytes;
  m.def(
      "check_inertia",
      [](const std::string& link, double mass, const Array& inertia) {
        if (inertia.ndim() != 2 || inertia.shape(0) != 3 || inertia.shape(1) != 3) {
          throw std::invalid_argument("inertia must have shape (3, 3), got " + shape_of(inertia));
        }
        const Eigen::Map<const Eigen::Matrix3d> symmetric(inertia.data());
        dynamics::check_inertia({mass, Eigen::Vector3d::Zero(), symmetric}, link);
      },
      py::arg("link"), py::arg("mass"), py::arg("inertia"),
      R"(Refuses a mass [kg] with an inertia (3, 3) [kg m2] about the center of mass that no body can have.

Raises: UrdfError naming the link and its principal moments.)");
  m.def(
      "check_urdf",
      [](const py::bytes& content, bool is_utf8, bool as_published) {
        using dynamics::XmlEncoding;
        return dynamics::check_urdf(std::string_view(content),
                                    is_utf8 ? XmlEncoding::kUtf8 : XmlEncoding::kDeclared,
                                    as_published);
      },
      py::arg("content"), py::arg("is_utf8") = false, py::arg("as_published") = false,
      R"(Name of the root link of a URDF whose links, joints, inertias and shapes can be used.

Args:
    content: the text as bytes.
    is_utf8: read it as UTF-8, whatever byte order mark and XML declaration say.
    as_published: accept inertia tensors that no body can have; judged are the links that move as one.
Raises: UrdfError naming line and element of all faults.)");
  m.def("load_urdf", &load_urdf, py::arg("text_or_path"), py::arg("joints") = py::none(),
        py::arg("as_published") = false, py::arg("fixed_base") = false,
        R"(The robot in a URDF, given as text or as the path of a file.

Args:
    text_or_path: the text (starts with '<') or a path.
    joints: names of the joints that move, in the wanted order; all others are locked at position
        0 and their links lumped. None: every joint that is not fixed and mimics no other one, in
        the order of the URDF. Joints that mimic one of them move along.
    as_published: accept inertia tensors that no body can have; nothing else is waived.
    fixed_base: hold the root link; nu and all matrices then lose the six base coordinates.
Raises: UrdfError naming the element; UnknownNameError for a joint that is not there.)");
}

}  // namespace

void bind_dynamics(py::module_& m) {
  using namespace pybind11::literals;
  bind_model(m);
  m.def("mass_matrix", &mass_matrix, "model"_a, "base_pose"_a, "s"_a,
        "M (6+n, 6+n) of M nu_dot + b = (0, tau) + sum of J^T wrench; mixed convention.");
  m.def("bias_forces", &bias_forces, "model"_a, "base_pose"_a, "s"_a, "nu"_a,
        "b (6+n,): gravity, Coriolis and centrifugal forces [N, N m].");
  m.def("gravity_forces", &gravity_forces, "model"_a, "base_pose"_a, "s"_a,
        "The bias forces at rest (6+n,) [N, N m].");
  m.def("inverse_dynamics", &inverse_dynamics, "model"_a, "base_pose"_a, "s"_a, "nu"_a, "nu_dot"_a,
        "M nu_dot + b (6+n,) [N, N m], by the recursive Newton-Euler algorithm.");
  m.def("forward_dynamics", &forward_dynamics, "model"_a, "base_pose"_a, "s"_a, "nu"_a, "tau"_a,
        "wrenches"_a = py::dict(),
        R"(Accelerations nu_dot (6+n,), by the articulated-body algorithm.

Args:
    tau: (n,) joint torques [N m] or forces [N].
    wrenches: frame name to force and moment (6,) [N, N m], world axes, at the frame's origin.
Raises: SolverError where the mass matrix is singular.)");
  m.def("center_of_mass", &center_of_mass, "model"_a, "base_pose"_a, "s"_a,
        "Center of mass (3,) in the world [m].");
  m.def("center_of_mass_velocity", &center_of_mass_velocity, "model"_a, "base_pose"_a, "s"_a,
        "nu"_a, "Velocity of the center of mass (3,) [m/s].");
  m.def("center_of_mass_jacobian", &center_of_mass_jacobian, "model"_a, "base_pose"_a, "s"_a,
        "Jacobian of the center of mass (3, 6+n).");
  m.def("centroidal_momentum", &centroidal_momentum, "model"_a, "base_pose"_a, "s"_a, "nu"_a,
        "Linear and angular momentum about the center of mass (6,), world axes.");
  m.def("centroidal_momentum_matrix", &centroidal_momentum_matrix, "model"_a, "base_pose"_a, "s"_a,
        "C (6, 6+n) with C nu = centroidal_momentum.");
  m.def("centroidal_momentum_bias", &centroidal_momentum_bias, "model"_a, "base_pose"_a, "s"_a,
        "nu"_a, "Rate of C times nu (6,): rate of the momentum where nu_dot = 0.");
  m.def("locked_inertia", &locked_inertia, "model"_a, "base_pose"_a, "s"_a,
        "Inertia (3, 3) of the robot frozen in its posture, about the center of mass, world axes.");
  m.def("kinetic_energy", &kinetic_energy, "model"_a, "base_pose"_a, "s"_a, "nu"_a, "[J]");
  m.def("potential_energy", &potential_energy, "model"_a, "base_pose"_a, "s"_a,
        "[J], zero with the center of mass at height 0 of the world.");
  m.def("frame_pose", &frame_pose, "model"_a, "base_pose"_a, "s"_a, "frame"_a,
        "Pose (4, 4) of a link in the world.");
  m.def("frame_jacobian", &frame_jacobian, "model"_a, "base_pose"_a, "s"_a, "frame"_a,
        "J (6, 6+n): velocity of the frame's origin and angular velocity, world axes.");
  m.def("frame_velocity", &frame_velocity, "model"_a, "base_pose"_a, "s"_a, "nu"_a, "frame"_a,
        "J nu (6,) [m/s, rad/s].");
  m.def("frame_bias_acceleration", &frame_bias_acceleration, "model"_a, "base_pose"_a, "s"_a,
        "nu"_a, "frame"_a, "Rate of J times nu (6,) [m/s^2, rad/s^2].");
}

}  // namespace codesign
