#pragma once

#include <vector>

#include "dynamics/predictive_settings.hpp"

namespace codesign::dynamics {

// The steps of a prediction and what acts in each. Small steps follow τ(k) = β₁ k + β₂ k² with
// τ(1) = period and τ(small_steps) = large_step.
//
// The unknowns are blocks of joint displacements and of throttle variables. Their order is that of
// their first use, so what a step depends on is a growing prefix of the unknowns.
struct PredictionGrid {
  struct Step {
    double length = 0.0;  // [s]
    double end = 0.0;     // time from the solve [s]
    int joint_block = 0, throttle_block = 0;
    int used = 0;  // unknowns that act in this step or earlier
  };
  std::vector<Step> steps;
  std::vector<int> joint_columns;     // first unknown of each joint block
  std::vector<int> throttle_columns;  // first unknown of each throttle block
  int unknowns = 0;
};

// The grid of settings, for so many joints that move and so many jets.
PredictionGrid make_prediction_grid(const PredictiveSettings& settings, int joints, int jets);

}  // namespace codesign::dynamics
