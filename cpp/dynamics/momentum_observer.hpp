#pragma once

#include "dynamics/spatial.hpp"

namespace codesign::dynamics {

// Estimates the force and moment (about the center of mass, world axes) that act on the robot and
// that its model does not know: r = K (h − h(0) − ∫ (A T − (m g e₃; 0) + r) dt), so that ṙ = K
// (true rate of momentum − modeled rate − r). After De Luca and Mattone, "Sensorless robot
// collision detection and hybrid force/motion control", ICRA 2005, for the centroidal momentum.
class MomentumObserver {
 public:
  MomentumObserver(double gain, double step) : gain_(gain), step_(step) {}

  // Called once per step. momentum: of now. before, after: modeled rates of momentum of now, under
  // the thrusts of the step that ends and of the one that begins. Returns r.
  const Vector6d& update(const Vector6d& momentum, const Vector6d& before, const Vector6d& after);

 private:
  double gain_, step_;
  bool started_ = false;
  Vector6d last_rate_ = Vector6d::Zero(), explained_ = Vector6d::Zero(),
           estimate_ = Vector6d::Zero();
};

}  // namespace codesign::dynamics
