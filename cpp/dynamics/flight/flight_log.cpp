#include "dynamics/flight/flight_log.hpp"

namespace codesign::dynamics {

FlightLog make_flight_log(int samples, int joints, int jets) {
  FlightLog log;
  log.time.resize(samples, 1);
  log.base_rotation.resize(samples, 9);
  log.rotation_reference.resize(samples, 9);
  log.joint_positions.resize(samples, joints);
  log.velocity.resize(samples, 6 + joints);
  for (History* three : {&log.base_position, &log.com, &log.com_reference,
                         &log.com_velocity_reference, &log.angular_velocity_reference, &log.wind}) {
    three->resize(samples, 3);
  }
  log.momentum.resize(samples, 6);
  log.momentum_error.resize(samples, 6);
  log.unmodeled_force.resize(samples, 6);
  for (History* jet : {&log.thrust, &log.thrust_rate_command, &log.thrust_command}) {
    jet->resize(samples, jets);
  }
  log.joint_velocity_command.resize(samples, joints);
  log.torque.resize(samples, joints);
  log.clearance.resize(samples, 1);
  log.qp_iterations.resize(samples, 2);
  log.active_bounds.resize(samples, 1);
  return log;
}

void truncate(FlightLog& log) {
  for (History* history : {&log.time,
                           &log.base_position,
                           &log.base_rotation,
                           &log.joint_positions,
                           &log.velocity,
                           &log.com,
                           &log.com_reference,
                           &log.com_velocity_reference,
                           &log.rotation_reference,
                           &log.angular_velocity_reference,
                           &log.momentum,
                           &log.momentum_error,
                           &log.unmodeled_force,
                           &log.thrust,
                           &log.thrust_rate_command,
                           &log.thrust_command,
                           &log.joint_velocity_command,
                           &log.torque,
                           &log.wind,
                           &log.clearance}) {
    history->conservativeResize(log.samples, Eigen::NoChange);
  }
  log.qp_iterations.conservativeResize(log.samples, Eigen::NoChange);
  log.active_bounds.conservativeResize(log.samples, Eigen::NoChange);
}

}  // namespace codesign::dynamics
