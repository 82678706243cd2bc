#include <stdexcept>

#include "dynamics/flight/flight.hpp"
#include "dynamics/flight/flight_start.hpp"
#include "interrupt.hpp"

namespace codesign::dynamics {

namespace {

RobotState logged_state(const FlightLog& log, int k) {
  using RowMajorRotation = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  RobotState state;
  state.base.p = log.base_position.row(k).transpose();
  state.base.R = Eigen::Map<const RowMajorRotation>(log.base_rotation.row(k).data());
  state.joints = log.joint_positions.row(k).transpose();
  state.velocity = log.velocity.row(k).transpose();
  return state;
}

}  // namespace

std::vector<MomentumQp> momentum_qps(const Model& model, const FlightSettings& asked,
                                     const FlightLog& log, int every) {
  const FlightSettings settings = fitted(model, asked);
  if (every < 1) throw std::invalid_argument("momentum_qps: every must be at least 1");
  if (log.velocity.cols() != model.dofs() || log.step != settings.step) {
    throw std::invalid_argument("momentum_qps: the log is not of this model and these settings");
  }
  std::vector<MomentumQp> qps;
  if (log.samples == 0) return qps;
  const int jets = static_cast<int>(settings.actuators.size());
  RobotTerms terms(model, settings.actuators);
  update_terms(model, logged_state(log, 0), terms);
  const ControllerOrigin origin = controller_origin(settings, logged_state(log, 0), terms);
  ReferenceGenerator generator(settings, terms.com, logged_state(log, 0).base.R);
  MomentumTask task(jets, model.joint_count());
  MomentumQp qp(settings, model.joint_count());
  for (int k = 0; k < log.samples; ++k) {
    check_interrupt();
    const Reference& reference =
        generator.update(command_at(settings.trajectory, k, settings.step));
    if (k % every != 0) continue;
    const RobotState state = logged_state(log, k);
    const Eigen::VectorXd thrust = log.thrust.row(k).transpose();
    const Vector6d unmodeled = log.unmodeled_force.row(k).transpose();
    update_terms(model, state, terms);
    build_momentum_task(model, settings, origin, state, terms, thrust, reference, unmodeled, task);
    build_momentum_qp(settings, origin, task, state, thrust, qp);
    qps.push_back(qp);
  }
  return qps;
}

}  // namespace codesign::dynamics
