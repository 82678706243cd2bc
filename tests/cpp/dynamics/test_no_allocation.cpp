// The per-step functions must not touch the heap: this executable counts every malloc.

#include <gtest/gtest.h>

#include "allocation_count.hpp"
#include "sample.hpp"

namespace codesign::dynamics {
namespace {

using namespace testing;

TEST(NoAllocation, PerStepFunctionsLeaveTheHeapAlone) {
  if (!kAllocationsAreCounted) GTEST_SKIP() << "malloc cannot be counted in this build";
  const Model model = load_urdf(random_robot(30, 1));
  const State state = random_state(model, 1);
  KinematicsData kin(model);
  VelocityData velocity(model);
  InertiaData inertia(model);
  ForceData forces(model);
  ArticulatedData articulated(model);
  const int n = model.dofs(), frame = 20;
  Eigen::MatrixXd M(n, n);
  Eigen::VectorXd b(n), g(n), tau = Eigen::VectorXd::Ones(model.joint_count()), nu_dot(n);
  Matrix6Xd J(6, n), C(6, n);
  Eigen::Matrix<double, 3, Eigen::Dynamic> Jc(3, n);
  const std::vector<FrameWrench> wrenches = {{frame, Vector6d::Ones()}};
  const long before = allocation_count;
  forward_kinematics(model, state.base, state.s, kin);
  forward_velocities(model, kin, state.nu, velocity);
  compute_inertias(model, kin, inertia);
  mass_matrix(model, kin, inertia, M);
  bias_forces(model, kin, inertia, velocity, forces, b);
  gravity_forces(model, kin, inertia, g);
  frame_jacobian(model, kin, frame, J);
  centroidal_momentum_matrix(model, kin, inertia, C);
  center_of_mass_jacobian(model, kin, inertia, Jc);
  forward_dynamics(model, kin, inertia, velocity, tau, wrenches, articulated, nu_dot);
  inverse_dynamics(model, kin, inertia, velocity, nu_dot, forces, b);
  const Vector6d total = frame_velocity(model, kin, velocity, frame) +
                         frame_bias_acceleration(model, kin, velocity, frame) +
                         centroidal_momentum(model, kin, inertia, velocity) +
                         centroidal_momentum_bias(model, kin, inertia, velocity);
  const Pose pose = frame_pose(model, kin, frame);
  const double energy =
      kinetic_energy(model, kin, inertia, velocity) + potential_energy(kin, inertia);
  EXPECT_EQ(allocation_count - before, 0);
  EXPECT_GT(before, 0);  // the counter works
  EXPECT_TRUE(total.allFinite() && pose.R.allFinite() && std::isfinite(energy));
}

}  // namespace
}  // namespace codesign::dynamics
