#include "dynamics/drives.hpp"

#include <cmath>

namespace codesign::dynamics {

const Eigen::VectorXd& DelayLine::pass(const Eigen::VectorXd& value) {
  if (!started_) {
    started_ = true;
    for (Eigen::VectorXd& stored : values_) stored = value;
  }
  values_[next_] = value;
  next_ = (next_ + 1) % values_.size();
  return values_[next_];
}

Drives::Drives(const FlightSettings& settings)
    : delay_(static_cast<int>(
          std::lround(settings.delays.torque * settings.torque_updates / settings.step))),
      share_(
          settings.delays.torque_lag > 0.0
              ? -std::expm1(-settings.step / settings.torque_updates / settings.delays.torque_lag)
              : 1.0),
      torque_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(settings.joints.size()))) {}

const Eigen::VectorXd& Drives::act(const Eigen::VectorXd& wanted) {
  const Eigen::VectorXd& late = delay_.pass(wanted);
  if (share_ == 1.0 || !started_) {
    started_ = true;
    torque_ = late;
  } else {
    torque_ += share_ * (late - torque_);
  }
  return torque_;
}

void add_friction(const Friction& friction, const Eigen::Ref<const Eigen::VectorXd>& joint_velocity,
                  Eigen::Ref<Eigen::VectorXd> joint_force) {
  if (friction.viscous.size() > 0) joint_force -= friction.viscous.cwiseProduct(joint_velocity);
  if (friction.coulomb.size() > 0) {
    joint_force.array() -=
        friction.coulomb.array() * (joint_velocity.array() / friction.slip_speed).tanh();
  }
}

}  // namespace codesign::dynamics
