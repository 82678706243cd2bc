#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "dynamics/centroidal.hpp"
#include "sample.hpp"

namespace codesign::dynamics {
namespace {

using namespace testing;

constexpr double kStep = 1e-5;

TEST(Centroidal, MatrixTimesVelocityIsTheSumOverTheBodies) {
  for (const Model& model : models()) {
    const State state = random_state(model, 1);
    const Sample sample(model, state);
    EXPECT_LT(relative_error(sample.C() * state.nu, sample.momentum()), 1e-13);
    EXPECT_LT((sample.com_jacobian() * state.nu -
               center_of_mass_velocity(model, sample.kin, sample.inertia, sample.velocity))
                  .norm(),
              1e-13 * (1.0 + state.nu.norm()));
  }
}

TEST(Centroidal, CenterOfMassMovesWithItsJacobian) {
  for (const Model& model : models()) {
    const State state = random_state(model, 2);
    const Sample here(model, state), next(model, moved(model, state, kStep)),
        last(model, moved(model, state, -kStep));
    const Eigen::Vector3d rate =
        (center_of_mass(next.kin, next.inertia) - center_of_mass(last.kin, last.inertia)) /
        (2.0 * kStep);
    const Eigen::Vector3d velocity = here.com_jacobian() * state.nu;
    EXPECT_LT((rate - velocity).norm(), 1e-7 * (1.0 + std::pow(velocity.norm(), 3)));
  }
}

TEST(Centroidal, MatrixFollowsFromTheMassMatrix) {
  for (const Model& model : models()) {
    if (model.fixed_base) continue;
    const Sample sample(model, random_state(model, 3));
    const Eigen::MatrixXd rows = sample.M().topRows<6>();
    Matrix6Xd C = rows;
    C.bottomRows<3>() -= skew(sample.inertia.subtrees[0].com) * rows.topRows<3>();
    EXPECT_LT(relative_error(sample.C(), C), 1e-13);
  }
}

TEST(Centroidal, BiasIsTheRateOfTheMomentumAtConstantVelocity) {
  for (const Model& model : models()) {
    const State state = random_state(model, 4);
    const Sample here(model, state), next(model, moved(model, state, kStep)),
        last(model, moved(model, state, -kStep));
    const Vector6d rate = (next.momentum() - last.momentum()) / (2.0 * kStep);
    const Vector6d bias = centroidal_momentum_bias(model, here.kin, here.inertia, here.velocity);
    EXPECT_LT((rate - bias).norm(), 1e-5 * (1.0 + bias.norm()));
  }
}

TEST(Centroidal, MomentumChangesByGravityAndExternalForcesOnly) {
  for (const Model& model : models()) {
    if (model.fixed_base) continue;
    Sample sample(model, random_state(model, 5));
    const int frame = static_cast<int>(model.frames.size()) / 2;
    const std::vector<FrameWrench> wrenches = {{frame, random_vector(6, 6, 50.0)}};
    const Eigen::VectorXd tau = random_vector(model.joint_count(), 7, 10.0);
    const Eigen::VectorXd nu_dot = sample.forward(tau, wrenches);
    const Vector6d rate =
        sample.C() * nu_dot +
        centroidal_momentum_bias(model, sample.kin, sample.inertia, sample.velocity);
    const Eigen::Vector3d force = wrenches[0].wrench.head<3>(),
                          moment = wrenches[0].wrench.tail<3>();
    const Eigen::Vector3d arm =
        frame_pose(model, sample.kin, frame).p - center_of_mass(sample.kin, sample.inertia);
    Vector6d expected;
    expected << force - Eigen::Vector3d(0.0, 0.0, model.total_mass * kGravity),
        moment + arm.cross(force);
    // C nu_dot and the bias cancel to what is expected: relative to them.
    EXPECT_LT((rate - expected).norm(), 1e-9 * (expected.norm() + (sample.C() * nu_dot).norm()));
  }
}

TEST(Centroidal, LockedInertiaIsTheAngularMomentumOfATurningStatue) {
  for (const Model& model : models()) {
    if (model.fixed_base) continue;
    State state = random_state(model, 8);
    state.nu.tail(model.joint_count()).setZero();
    const Sample sample(model, state);
    const Eigen::Vector3d turning = state.nu.segment<3>(3);
    EXPECT_LT((locked_inertia(sample.inertia) * turning - sample.momentum().tail<3>()).norm(),
              1e-12 * sample.momentum().norm());
  }
}

TEST(Centroidal, FreeFlightKeepsMomentumAndEnergyToFourthOrder) {
  const Model model = load_urdf(random_robot(10, 9));
  const auto drift = [&](int steps) {
    const double h = 0.2 / steps;
    State state = random_state(model, 9);
    state.nu *= 0.3;
    const Vector6d momentum = Sample(model, state).momentum();
    const double energy = Sample(model, state).energy();
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(model.joint_count());
    // Runge-Kutta 4 on (base pose, s, nu); the base rotation by its rotation vector from the start
    // of the step, whose rate is that of nu to the order needed with the correction ½ v × ω + ...
    for (int k = 0; k < steps; ++k) {
      struct Rate {
        Eigen::VectorXd position, velocity;
      };
      const auto at = [&](const Eigen::VectorXd& dq, const Eigen::VectorXd& dnu) {
        State next{{exp_so3(dq.segment<3>(3)) * state.base.R, state.base.p + dq.head<3>()},
                   state.s + dq.tail(model.joint_count()),
                   state.nu + dnu};
        Rate rate{next.nu, Sample(model, next).forward(rest)};
        const Eigen::Vector3d v = dq.segment<3>(3), w = next.nu.segment<3>(3);
        rate.position.segment<3>(3) = w - 0.5 * v.cross(w) + v.cross(v.cross(w)) / 12.0;
        return rate;
      };
      const Eigen::VectorXd zero = Eigen::VectorXd::Zero(model.dofs());
      const Rate a = at(zero, zero);
      const Rate b = at(0.5 * h * a.position, 0.5 * h * a.velocity);
      const Rate c = at(0.5 * h * b.position, 0.5 * h * b.velocity);
      const Rate d = at(h * c.position, h * c.velocity);
      const Eigen::VectorXd dq =
          h / 6.0 * (a.position + 2.0 * b.position + 2.0 * c.position + d.position);
      state.base = {exp_so3(dq.segment<3>(3)) * state.base.R, state.base.p + dq.head<3>()};
      state.s += dq.tail(model.joint_count());
      state.nu += h / 6.0 * (a.velocity + 2.0 * b.velocity + 2.0 * c.velocity + d.velocity);
    }
    const Sample end(model, state);
    const double angular = (end.momentum() - momentum).tail<3>().norm();
    return std::pair(angular, std::abs(end.energy() - energy));
  };
  const auto [angular_coarse, energy_coarse] = drift(50);
  const auto [angular_fine, energy_fine] = drift(100);
  EXPECT_GT(angular_coarse / angular_fine, 12.0);  // 16 for a fourth-order method
  EXPECT_GT(energy_coarse / energy_fine, 12.0);
}

}  // namespace
}  // namespace codesign::dynamics
