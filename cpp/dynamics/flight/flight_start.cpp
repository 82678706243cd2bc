#include "dynamics/flight/flight_start.hpp"

#include <stdexcept>

namespace codesign::dynamics {

FlightSettings fitted(const Model& model, const FlightSettings& settings) {
  validate(settings);
  if (model.fixed_base) throw std::invalid_argument("simulate_flight: the model's base is fixed");
  bool same = model.joints.size() == settings.joints.size();
  for (std::size_t i = 0; same && i < model.joints.size(); ++i) {
    same = model.joints[i].name == settings.joints[i];
  }
  if (!same) {
    throw std::invalid_argument(
        "simulate_flight: the model's joints are not those of the settings; load it with "
        "joints=settings.joints");
  }
  FlightSettings result = settings;
  const bool predictive = settings.controller == Controller::kPredictive;
  if (predictive) result.limits.joint_range_scale.setOnes(model.joint_count());
  if (predictive || settings.limits.joint_lower.size() == 0) {
    result.limits.joint_lower.resize(model.joint_count());
    result.limits.joint_upper.resize(model.joint_count());
    for (Eigen::Index j = 0; j < model.joint_count(); ++j) {
      result.limits.joint_lower[j] = model.joints[static_cast<std::size_t>(j)].lower;
      result.limits.joint_upper[j] = model.joints[static_cast<std::size_t>(j)].upper;
    }
  }
  return result;
}

JointRanges controlled_ranges(const FlightSettings& settings) {
  const Limits& limits = settings.limits;
  return {limits.joint_range_scale.cwiseProduct(limits.joint_lower),
          limits.joint_range_scale.cwiseProduct(limits.joint_upper)};
}

FlightStart flight_start(const Model& model, const FlightSettings& settings) {
  FlightStart start;
  start.state.base.p = settings.base_pose.topRightCorner<3, 1>();
  start.state.base.R = settings.base_pose.topLeftCorner<3, 3>();
  start.state.joints = settings.initial_joints;
  start.state.velocity.setZero(model.dofs());
  start.thrusts = settings.initial_thrusts;
  if (!settings.trim) return start;
  const Trim trim = trim_hover(model, settings.actuators, start.state.base, start.state.joints,
                               controlled_ranges(settings), *settings.trim);
  start.hovers = trim.reached;
  start.state.base = trim.base;
  start.state.joints = trim.joints;
  start.thrusts = trim.thrusts;
  return start;
}

}  // namespace codesign::dynamics
