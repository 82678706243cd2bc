#pragma once

#include <utility>

#include "dynamics/model.hpp"
#include "dynamics/rigid_body.hpp"

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
        forces(*this) {}

  mutable dynamics::KinematicsData kin;
  mutable dynamics::VelocityData velocity;
  mutable dynamics::InertiaData inertia;
  mutable dynamics::ForceData forces;
};

}  // namespace codesign
