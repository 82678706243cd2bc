#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <vector>

#include "bindings/bindings.hpp"
#include "bindings/py_model.hpp"
#include "dynamics/centroidal.hpp"
#include "dynamics/urdf.hpp"

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

VectorMap vector(const char* name, const Array& array, int size) {
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

Array mass_matrix(const PyModel& model, const Array& base_pose, const Array& s) {
  set_inertias(model, base_pose, s);
  Array result({model.dofs(), model.dofs()});
  Eigen::Map<Eigen::MatrixXd> M(result.mutable_data(), model.dofs(), model.dofs());
  dynamics::mass_matrix(model, model.kin, model.inertia, M);
  return result;
}

Array bias_forces(const PyModel& model, const Array& base_pose, const Array& s, const Array& nu) {
  set_inertias(model, base_pose, s);
  set_velocities(model, nu);
  Array result(model.dofs());
  Eigen::Map<Eigen::VectorXd> b(result.mutable_data(), model.dofs());
  dynamics::bias_forces(model, model.kin, model.inertia, model.velocity, model.forces, b);
  return result;
}

Array center_of_mass(const PyModel& model, const Array& base_pose, const Array& s) {
  set_inertias(model, base_pose, s);
  return to_array((dynamics::center_of_mass(model.kin, model.inertia)));
}

Array centroidal_momentum(const PyModel& model, const Array& base_pose, const Array& s,
                          const Array& nu) {
  set_inertias(model, base_pose, s);
  set_velocities(model, nu);
  return to_array(Eigen::VectorXd(
      dynamics::centroidal_momentum(model, model.kin, model.inertia, model.velocity)));
}

Array centroidal_momentum_matrix(const PyModel& model, const Array& base_pose, const Array& s) {
  set_inertias(model, base_pose, s);
  dynamics::Matrix6Xd C(6, model.dofs());
  dynamics::centroidal_momentum_matrix(model, model.kin, model.inertia, C);
  return to_array(C);
}

Array frame_pose(const PyModel& model, const Array& base_pose, const Array& s,
                 const std::string& frame) {
  set_positions(model, base_pose, s);
  const Pose T = dynamics::frame_pose(model, model.kin, dynamics::frame_index(model, frame));
  Eigen::Matrix4d result = Eigen::Matrix4d::Identity();
  result.topLeftCorner<3, 3>() = T.R;
  result.topRightCorner<3, 1>() = T.p;
  return to_array(result);
}

Array frame_jacobian(const PyModel& model, const Array& base_pose, const Array& s,
                     const std::string& frame) {
  set_positions(model, base_pose, s);
  dynamics::Matrix6Xd J(6, model.dofs());
  dynamics::frame_jacobian(model, model.kin, dynamics::frame_index(model, frame), J);
  return to_array(J);
}

PyModel load_urdf(const std::string& text_or_path, std::optional<std::vector<std::string>> joints,
                  bool as_published, bool fixed_base) {
  return PyModel(dynamics::load_urdf(text_or_path, {std::move(joints), as_published, fixed_base}));
}

template <typename Named>
std::vector<std::string> names(const std::vector<Named>& items) {
  std::vector<std::string> result;
  for (const Named& item : items) result.push_back(item.name);
  return result;
}

}  // namespace

void bind_dynamics(py::module_& m) {
  py::class_<PyModel>(m, "Model")
      .def_property_readonly("joint_names",
                             [](const PyModel& model) { return names(model.joints); })
      .def_property_readonly("frame_names",
                             [](const PyModel& model) { return names(model.frames); })
      .def_readonly("total_mass", &PyModel::total_mass);
  m.def("load_urdf", &load_urdf, py::arg("text_or_path"), py::arg("joints") = py::none(),
        py::arg("as_published") = false, py::arg("fixed_base") = false);
  m.def("mass_matrix", &mass_matrix);
  m.def("bias_forces", &bias_forces);
  m.def("center_of_mass", &center_of_mass);
  m.def("centroidal_momentum", &centroidal_momentum);
  m.def("centroidal_momentum_matrix", &centroidal_momentum_matrix);
  m.def("frame_pose", &frame_pose);
  m.def("frame_jacobian", &frame_jacobian);
}

}  // namespace codesign
