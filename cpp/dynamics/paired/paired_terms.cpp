#include <Eigen/Geometry>

#include "dynamics/both_widths.hpp"
#include "dynamics/paired/lane_access.hpp"
#include "dynamics/paired/paired_bodies.hpp"

// Terms of the equations of motion. Mass matrix and momentum matrix by composite rigid bodies,
// about the base's origin: inertias of subtrees are plain sums there, and a joint's momentum needs
// no moving along its ancestors.
namespace codesign::dynamics {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void PairedBodies::find_ancestors(int index) {
  Row& row = rows_[static_cast<std::size_t>(index)];
  std::array<Place, 2> at = {Place{index, 0}, Place{index, row.single ? 0 : 1}};
  while (at[0].row != 0) {
    const Row& there = rows_[static_cast<std::size_t>(at[0].row)];
    if (at[0].row != at[1].row) {  // the lanes part: from here on, each its own way
      row.ancestors.push_back({at[0].row, {at[0].lane, -1}, false});
      row.ancestors.push_back({at[1].row, {-1, at[1].lane}, false});
    } else {
      const bool aligned = at[0].lane == 0 && (at[1].lane == 1 || row.single);
      row.ancestors.push_back({at[0].row, {at[0].lane, at[1].lane}, aligned || there.single});
    }
    for (Place& place : at) {
      const Row& below = rows_[static_cast<std::size_t>(place.row)];
      place = below.parent[static_cast<std::size_t>(below.single ? 0 : place.lane)];
    }
  }
}

// Of each body alone, then of the subtrees.
CODESIGN_BOTH_WIDTHS
void PairedBodies::start_composites() {
  for (Row& row : rows_) {
    const Motion& m = row.motion;
    const LaneVector center = m.p + row.arm;
    const LaneVector h = row.mass * center;
    const LaneSymmetric& own = row.world_inertia;
    const Lanes xx = h.x * center.x, yy = h.y * center.y, zz = h.z * center.z;
    row.composite = {row.mass,
                     h,
                     {own.xx + yy + zz, own.xy - h.x * center.y, own.xz - h.x * center.z,
                      own.yy + zz + xx, own.yz - h.y * center.z, own.zz + xx + yy}};
    const LaneVector turn = row.turns * m.R.c;
    row.twist = {cross(m.p, turn), turn};
    if (row.prismatic) row.twist.linear = row.twist.linear + row.slides * m.R.c;
  }
  for (std::size_t i = rows_.size() - 1; i > 0; --i) {
    const Row& row = rows_[i];
    if (row.adds_straight) {
      Composite& below = rows_[static_cast<std::size_t>(row.parent[0].row)].composite;
      below = {below.mass + row.composite.mass, below.first + row.composite.first,
               below.second + row.composite.second};
      continue;
    }
    for (int lane = 0; lane < (row.single ? 1 : 2); ++lane) {
      const Place parent = row.parent[static_cast<std::size_t>(lane)];
      Row& below = rows_[static_cast<std::size_t>(parent.row)];
      add_lane(row.composite, lane, below.composite, parent.lane);
      if (below.single) add_lane(row.composite, lane, below.composite, 1 - parent.lane);
    }
  }
}

// The columns of the row's joints: the momentum of the subtree per unit of joint velocity,
// projected on the motions of the joints below and of the base.
CODESIGN_BOTH_WIDTHS
void PairedBodies::write_column(const Row& row, const Vector3d& com, Eigen::MatrixXd& M,
                                Matrix6Xd& C) {
  const Composite& all = row.composite;
  const LaneVector &v = row.twist.linear, &w = row.twist.angular;
  const Twist momentum = {all.mass * v + cross(w, all.first), all.second * w + cross(all.first, v)};
  const auto size = M.outerStride();
  const int lanes_used = row.single ? 1 : 2;
  for (int lane = 0; lane < lanes_used; ++lane) {
    const int column = kBaseDofs + row.joint[static_cast<std::size_t>(lane)];
    const Vector3d linear = of_lane(momentum.linear, lane);
    const Vector3d angular = of_lane(momentum.angular, lane);
    double* down = M.data() + column * size;
    double* across = M.data() + column;
    double* central = C.data() + column * 6;
    const Vector3d about = angular - com.cross(linear);
    for (int i = 0; i < 3; ++i) {
      down[i] = across[i * size] = central[i] = linear[i];
      down[3 + i] = across[(3 + i) * size] = angular[i];
      central[3 + i] = about[i];
    }
  }
  for (const Ancestor& ancestor : row.ancestors) {
    const Row& below = rows_[static_cast<std::size_t>(ancestor.row)];
    if (ancestor.straight) {
      const Lanes entry =
          dot(below.twist.linear, momentum.linear) + dot(below.twist.angular, momentum.angular);
      for (int lane = 0; lane < lanes_used; ++lane) {
        const auto l = static_cast<std::size_t>(lane);
        const int i = kBaseDofs + below.joint[l], j = kBaseDofs + row.joint[l];
        M.data()[i + j * size] = M.data()[j + i * size] = entry[lane];
      }
      continue;
    }
    for (int lane = 0; lane < lanes_used; ++lane) {
      const auto l = static_cast<std::size_t>(lane);
      const int to = ancestor.lane[l];
      if (to < 0) continue;
      const int i = kBaseDofs + below.joint[static_cast<std::size_t>(to)];
      const int j = kBaseDofs + row.joint[l];
      M(i, j) = M(j, i) = of_lane(below.twist.linear, to).dot(of_lane(momentum.linear, lane)) +
                          of_lane(below.twist.angular, to).dot(of_lane(momentum.angular, lane));
    }
  }
  for (int lane = 0; lane < lanes_used; ++lane) {
    const int j = kBaseDofs + row.joint[static_cast<std::size_t>(lane)];
    M(j, j) += row.rotor[lane];
  }
}

void PairedBodies::write_mass_matrix(Eigen::MatrixXd& M, Matrix6Xd& C, RigidInertia& robot) {
  start_composites();
  const Composite& all = rows_[0].composite;
  const Vector3d first = of_lane(all.first, 0);
  const Matrix3d second = of_lane(all.second, 0);
  robot.mass = all.mass[0];
  robot.com = first / robot.mass;
  robot.inertia = second - point_inertia(robot.mass, robot.com);
  M.topLeftCorner<3, 3>().diagonal().setConstant(robot.mass);
  M.block<3, 3>(3, 0) = skew(first);
  M.block<3, 3>(0, 3) = skew(-first);
  M.block<3, 3>(3, 3) = second;
  C.topLeftCorner<3, 3>().diagonal().setConstant(robot.mass);
  C.block<3, 3>(0, 3) = skew(-first);
  C.block<3, 3>(3, 3) = robot.inertia;
  for (std::size_t i = 1; i < rows_.size(); ++i) write_column(rows_[i], robot.com, M, C);
}

CODESIGN_BOTH_WIDTHS
void PairedBodies::generalized_forces(Eigen::Ref<Eigen::VectorXd> forces) {
  for (Row& row : rows_) {
    row.carried_force = row.articulated.force;
    row.carried_moment = row.articulated.moment;
  }
  for (std::size_t i = rows_.size() - 1; i > 0; --i) {
    const Row& row = rows_[i];
    const LaneVector& force = row.carried_force;
    const Lanes on_joint = dot(row.motion.R.c, row.turns * row.carried_moment + row.slides * force);
    const LaneVector moment = row.carried_moment + cross(row.offset, force);
    for (std::size_t l = 0; l < 2; ++l) forces[kBaseDofs + row.joint[l]] = -on_joint[l];
    if (row.adds_straight) {
      Row& below = rows_[static_cast<std::size_t>(row.parent[0].row)];
      below.carried_force = below.carried_force + force;
      below.carried_moment = below.carried_moment + moment;
      continue;
    }
    for (int lane = 0; lane < (row.single ? 1 : 2); ++lane) {
      const auto l = static_cast<std::size_t>(lane);
      Row& below = rows_[static_cast<std::size_t>(row.parent[l].row)];
      for (int to = 0; to < 2; ++to) {
        if (!below.single && to != row.parent[l].lane) continue;
        add_lane(force, lane, below.carried_force, to);
        add_lane(moment, lane, below.carried_moment, to);
      }
    }
  }
  forces.head<3>() = -of_lane(rows_[0].carried_force, 0);
  forces.segment<3>(3) = -of_lane(rows_[0].carried_moment, 0);
}

void PairedBodies::write_poses(std::vector<BodyPose>& poses) const {
  for (const Row& row : rows_) {
    for (int lane = 0; lane < (row.single ? 1 : 2); ++lane) {
      BodyPose& pose = poses[static_cast<std::size_t>(row.body[static_cast<std::size_t>(lane)])];
      pose.R.col(0) = of_lane(row.motion.R.a, lane);
      pose.R.col(1) = of_lane(row.motion.R.b, lane);
      pose.R.col(2) = of_lane(row.motion.R.c, lane);
      pose.p = of_lane(row.motion.p, lane);
      pose.offset = of_lane(row.offset, lane);
    }
  }
}

}  // namespace codesign::dynamics
