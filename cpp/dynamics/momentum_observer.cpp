#include "dynamics/momentum_observer.hpp"

namespace codesign::dynamics {

const Vector6d& MomentumObserver::update(const Vector6d& momentum, const Vector6d& before,
                                         const Vector6d& after) {
  if (gain_ == 0.0) return estimate_;
  if (started_) {
    explained_ += step_ * (0.5 * (last_rate_ + before) + estimate_);
  } else {
    started_ = true;
    explained_ = momentum;
  }
  last_rate_ = after;
  estimate_ = gain_ * (momentum - explained_);
  return estimate_;
}

}  // namespace codesign::dynamics
