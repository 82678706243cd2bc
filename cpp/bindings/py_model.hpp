#pragma once

#include <pybind11/numpy.h>

#include <utility>
#include <vector>

#include "dynamics/forward_dynamics.hpp"
#include "dynamics/model.hpp"

namespace codesign {

// What Python knows as codesign.dynamics.Model: a model with the scratch that the microsecond calls
// reuse. These calls keep the GIL, which makes the shared scratch safe. Long calls take it as a
// plain const dynamics::Model& and bring scratch of their own.
struct PyModel : dynamics::Model {
  explicit PyModel(dynamics::Model model)
      : dynamics::Model(std::move(model)),
        kin(*this),
        velocity(*this),
        inertia(*this),
        forces(*this),
        articulated(*this),
        six_rows(6, dofs()),
        three_rows(3, dofs()) {}

  mutable dynamics::KinematicsData kin;
  mutable dynamics::VelocityData velocity;
  mutable dynamics::InertiaData inertia;
  mutable dynamics::ForceData forces;
  mutable dynamics::ArticulatedData articulated;
  mutable dynamics::Matrix6Xd six_rows;
  mutable Eigen::Matrix<double, 3, Eigen::Dynamic> three_rows;
  mutable std::vector<dynamics::FrameWrench> wrenches;
};

}  // namespace codesign
