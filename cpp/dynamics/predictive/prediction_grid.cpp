#include "dynamics/predictive/prediction_grid.hpp"

#include <algorithm>

namespace codesign::dynamics {

PredictionGrid make_prediction_grid(const PredictiveSettings& settings, int joints, int jets) {
  PredictionGrid grid;
  const int small = settings.small_steps;
  const double quadratic =
      small > 1 ? (settings.large_step - small * settings.period) / (small * small - small) : 0.0;
  const double linear = settings.period - quadratic;
  const auto warp = [&](int k) { return linear * k + quadratic * k * k; };
  double end = 0.0;
  for (int k = 0; k < small + settings.large_steps; ++k) {
    PredictionGrid::Step step;
    step.length = k < small ? warp(k + 1) - warp(k) : settings.large_step;
    end = k < small ? warp(k + 1) : end + settings.large_step;
    step.end = end;
    step.joint_block = std::min(k, settings.control_steps - 1);
    step.throttle_block = std::clamp(k - small + 1, 0, settings.control_steps - small);
    if (step.joint_block == static_cast<int>(grid.joint_columns.size())) {
      grid.joint_columns.push_back(grid.unknowns);
      grid.unknowns += joints;
    }
    if (step.throttle_block == static_cast<int>(grid.throttle_columns.size())) {
      grid.throttle_columns.push_back(grid.unknowns);
      grid.unknowns += jets;
    }
    step.used = grid.unknowns;
    grid.steps.push_back(step);
  }
  return grid;
}

}  // namespace codesign::dynamics
