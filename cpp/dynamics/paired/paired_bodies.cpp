#include "dynamics/paired/paired_bodies.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cassert>
#include <tuple>

#include "dynamics/both_widths.hpp"
#include "dynamics/paired/lane_access.hpp"

namespace codesign::dynamics {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

LaneMatrix operator+(const LaneMatrix& a, const LaneMatrix& b) {
  return {a.a + b.a, a.b + b.b, a.c + b.c};
}

// Depth of each body below the base, and how many bodies its subtree has.
void measure_tree(const Model& model, std::vector<int>& depth, std::vector<int>& size) {
  depth.assign(model.bodies.size(), 0);
  size.assign(model.bodies.size(), 1);
  for (std::size_t i = 1; i < depth.size(); ++i) {
    depth[i] = depth[static_cast<std::size_t>(model.bodies[i].parent)] + 1;
  }
  for (std::size_t i = depth.size() - 1; i > 0; --i) {
    size[static_cast<std::size_t>(model.bodies[i].parent)] += size[i];
  }
}

}  // namespace

PairedBodies::PairedBodies(const Model& model, const Eigen::VectorXd& rotor_inertia)
    : places_(model.bodies.size()) {
  assert(!model.fixed_base && !model.mimics);
  place_bodies(model);
  for (int row = 1; row < static_cast<int>(rows_.size()); ++row) find_ancestors(row);
  for (Row& row : rows_) {
    row.rotor = lanes(0.0, 0.0);
    for (int lane = 0; lane < 2 && rotor_inertia.size() > 0 && &row != rows_.data(); ++lane) {
      row.rotor[lane] = rotor_inertia[row.joint[static_cast<std::size_t>(lane)]];
    }
  }
  for (int i = 0; i < model.body_count(); ++i) {
    set_inertia(i, model.bodies[static_cast<std::size_t>(i)].inertia);
  }
}

// Level by level: first bodies with subtrees of one size, which mirror images have, then what is
// left.
void PairedBodies::place_bodies(const Model& model) {
  std::vector<int> depth, size;
  measure_tree(model, depth, size);
  add_row(model, 0, 0);
  const int deepest = *std::max_element(depth.begin(), depth.end());
  for (int level = 1; level <= deepest; ++level) {
    std::vector<std::tuple<int, int, int, int>> found;  // size, row and lane of the parent, body
    for (int i = 1; i < model.body_count(); ++i) {
      const auto index = static_cast<std::size_t>(i);
      if (depth[index] != level) continue;
      const Place parent = places_[static_cast<std::size_t>(model.bodies[index].parent)];
      found.emplace_back(size[index], parent.row, parent.lane, i);
    }
    std::sort(found.begin(), found.end());
    std::vector<int> left;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const bool pair = i + 1 < found.size() && std::get<0>(found[i]) == std::get<0>(found[i + 1]);
      if (pair) {
        add_row(model, std::get<3>(found[i]), std::get<3>(found[i + 1]));
        ++i;
      } else {
        left.push_back(std::get<3>(found[i]));
      }
    }
    for (std::size_t i = 0; i < left.size(); i += 2) {
      add_row(model, left[i], i + 1 < left.size() ? left[i + 1] : left[i]);
    }
  }
}

void PairedBodies::add_row(const Model& model, int first, int second) {
  Row row = {};
  row.body = {first, second};
  row.single = first == second;
  for (int lane = 1; lane >= 0; --lane) {
    const auto l = static_cast<std::size_t>(lane);
    const Body& body = model.bodies[static_cast<std::size_t>(row.body[l])];
    places_[static_cast<std::size_t>(row.body[l])] = {static_cast<int>(rows_.size()), lane};
    if (body.parent == kNone) continue;
    row.joint[l] = body.joint;
    row.parent[l] = places_[static_cast<std::size_t>(body.parent)];
    row.turns[lane] = body.type == JointType::kRevolute ? 1.0 : 0.0;
    row.slides[lane] = 1.0 - row.turns[lane];
    row.prismatic = row.prismatic || body.type == JointType::kPrismatic;
    set_lane(row.parent_R_body.a, lane, body.parent_T_body.R.col(0));
    set_lane(row.parent_R_body.b, lane, body.parent_T_body.R.col(1));
    set_lane(row.parent_R_body.c, lane, body.parent_T_body.R.col(2));
    set_lane(row.parent_p_body, lane, body.parent_T_body.p);
  }
  if (!rows_.empty() && row.parent[0].row == row.parent[1].row) {
    const bool in_both = rows_[static_cast<std::size_t>(row.parent[0].row)].single;
    const bool aligned = row.parent[0].lane == 0 && row.parent[1].lane == 1;
    row.reads_straight = aligned || in_both;
    row.adds_straight = aligned || (in_both && row.single);
  }
  rows_.push_back(row);
}

void PairedBodies::set_inertia(int body, const RigidInertia& inertia) {
  const Place place = places_[static_cast<std::size_t>(body)];
  Row& row = rows_[static_cast<std::size_t>(place.row)];
  const Matrix3d& I = inertia.inertia;
  for (int lane = 0; lane < 2; ++lane) {
    if (row.body[static_cast<std::size_t>(lane)] != body) continue;
    row.mass[lane] = inertia.mass;
    set_lane(row.com, lane, inertia.com);
    row.inertia.xx[lane] = I(0, 0), row.inertia.yy[lane] = I(1, 1), row.inertia.zz[lane] = I(2, 2);
    row.inertia.xy[lane] = I(0, 1), row.inertia.xz[lane] = I(0, 2), row.inertia.yz[lane] = I(1, 2);
  }
}

template <class T>
T PairedBodies::of_parents(const Row& row, const T& first, const T& second) const {
  T result;
  for (std::size_t i = 0; i < kLaneCount<T>; ++i) {
    write_lane(&result, i, 0, read_lane(&first, i, row.parent[0].lane));
    write_lane(&result, i, 1, read_lane(&second, i, row.parent[1].lane));
  }
  return result;
}

void PairedBodies::move(const Matrix3d& world_R_base,
                        const Eigen::Ref<const Eigen::VectorXd>& joints,
                        const Eigen::Ref<const Eigen::VectorXd>& nu) {
  Motion& base = rows_[0].motion;
  base = Motion{};
  for (int lane = 0; lane < 2; ++lane) {
    set_lane(base.R.a, lane, world_R_base.col(0));
    set_lane(base.R.b, lane, world_R_base.col(1));
    set_lane(base.R.c, lane, world_R_base.col(2));
    set_lane(base.v, lane, nu.head<3>());
    set_lane(base.w, lane, nu.segment<3>(3));
  }
  start_row(rows_[0]);
  for (std::size_t i = 1; i < rows_.size(); ++i) {
    move_row(rows_[i], joints.data(), nu.data() + kBaseDofs);
    start_row(rows_[i]);
  }
}

void PairedBodies::move_with(const PairedBodies& other) {
  assert(rows_.size() == other.rows_.size());
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    rows_[i].motion = other.rows_[i].motion;
    rows_[i].offset = other.rows_[i].offset;
    start_row(rows_[i]);
  }
}

CODESIGN_BOTH_WIDTHS
void PairedBodies::move_row(Row& row, const double* joints, const double* rates) {
  const Motion& first = rows_[static_cast<std::size_t>(row.parent[0].row)].motion;
  const Motion& second = rows_[static_cast<std::size_t>(row.parent[1].row)].motion;
  Motion mixed;
  if (!row.reads_straight) mixed = of_parents(row, first, second);
  const Motion& parent = row.reads_straight ? first : mixed;
  Motion& m = row.motion;
  const LaneVector x = combine(parent.R, row.parent_R_body.a);
  const LaneVector y = combine(parent.R, row.parent_R_body.b);
  m.R.c = combine(parent.R, row.parent_R_body.c);
  row.offset = combine(parent.R, row.parent_p_body);
  const double position[2] = {joints[row.joint[0]], joints[row.joint[1]]};
  const Lanes angle = row.turns * lanes(position[0], position[1]);
  Lanes sine, cosine;
  sine_cosine(angle, sine, cosine);
  m.R.a = cosine * x + sine * y;
  m.R.b = cosine * y - sine * x;
  if (row.prismatic) {
    row.offset = row.offset + (row.slides * lanes(position[0], position[1])) * m.R.c;
  }
  m.p = parent.p + row.offset;
  const LaneVector rate = lanes(rates[row.joint[0]], rates[row.joint[1]]) * m.R.c;
  const LaneVector swing = cross(parent.w, row.offset);
  const LaneVector turn = row.turns * rate;
  m.v = parent.v + swing;
  m.w = parent.w + turn;
  m.a = parent.a + cross(parent.alpha, row.offset) + cross(parent.w, swing);
  m.alpha = parent.alpha + cross(parent.w, turn);
  if (row.prismatic) {
    const LaneVector slide = row.slides * rate;
    m.v = m.v + slide;
    m.a = m.a + lanes(2.0, 2.0) * cross(parent.w, slide);
  }
}

// The body alone: its own inertia and the wrench that ν̇ = 0 takes.
CODESIGN_BOTH_WIDTHS
void PairedBodies::start_row(Row& row) {
  const Motion& m = row.motion;
  Articulated& body = row.articulated;
  const LaneVector arm = row.arm = combine(m.R, row.com);
  const LaneSymmetric inertia = row.world_inertia = rotate(m.R, row.inertia);
  LaneVector acceleration = m.a + cross(m.alpha, arm) + cross(m.w, cross(m.w, arm));
  acceleration.z += lanes(kGravity, kGravity);
  body.force = row.mass * acceleration;
  body.moment = inertia * m.alpha + cross(m.w, inertia * m.w) + cross(arm, body.force);
  const LaneVector h = row.mass * arm;
  const Lanes zero = lanes(0.0, 0.0);
  body.linear = {row.mass, zero, zero, row.mass, zero, row.mass};
  body.coupling = {{zero, h.z, -h.y}, {-h.z, zero, h.x}, {h.y, -h.x, zero}};  // −S(h)
  const Lanes xx = h.x * arm.x, yy = h.y * arm.y, zz = h.z * arm.z;
  body.angular = {inertia.xx + yy + zz, inertia.xy - h.x * arm.y, inertia.xz - h.x * arm.z,
                  inertia.yy + zz + xx, inertia.yz - h.y * arm.z, inertia.zz + xx + yy};
}

// Removes the motion that the joints leave free, and hands the rest to the parents.
CODESIGN_BOTH_WIDTHS
void PairedBodies::hand_down(Row& row, const double* tau) {
  const Articulated& a = row.articulated;
  const LaneVector& axis = row.motion.R.c;
  const LaneMatrix& H = a.coupling;
  const LaneVector turn = row.turns * axis;
  row.joint_force = {dot(H.a, turn), dot(H.b, turn), dot(H.c, turn)};
  row.joint_moment = a.angular * turn;
  Lanes moved = dot(turn, row.joint_moment);
  Lanes taken = dot(turn, a.moment);
  if (row.prismatic) {
    const LaneVector slide = row.slides * axis;
    row.joint_force = row.joint_force + a.linear * slide;
    row.joint_moment = row.joint_moment + combine(H, slide);  // couplingᵀ: rows combined
    moved += dot(slide, a.linear * slide);
    taken += dot(slide, a.force);
  }
  row.per_joint_inertia = lanes(1.0, 1.0) / (moved + row.rotor);
  row.force_left = lanes(tau[row.joint[0]], tau[row.joint[1]]) - taken;
  const LaneVector f = row.per_joint_inertia * row.joint_force;
  const LaneVector m = row.per_joint_inertia * row.joint_moment;

  Articulated rest;
  rest.linear = less_product(a.linear, f, row.joint_force);
  const LaneMatrix c = {H.a - f.x * row.joint_moment, H.b - f.y * row.joint_moment,
                        H.c - f.z * row.joint_moment};
  // With the reference point moved by −d: H' = H − M S(d),  I' = I + S(d) H' + (S(d) H)ᵀ.
  const LaneVector& d = row.offset;
  rest.coupling = {c.a + cross(d, rest.linear.column_x()), c.b + cross(d, rest.linear.column_y()),
                   c.c + cross(d, rest.linear.column_z())};
  const LaneMatrix& k = rest.coupling;
  const LaneSymmetric own = less_product(a.angular, m, row.joint_moment);
  const auto along_x = [&](Lanes, Lanes y, Lanes z) { return d.y * z - d.z * y; };
  const auto along_y = [&](Lanes x, Lanes, Lanes z) { return d.z * x - d.x * z; };
  const auto along_z = [&](Lanes x, Lanes y, Lanes) { return d.x * y - d.y * x; };
  rest.angular = {own.xx + along_x(k.a.x, k.b.x, k.c.x) + along_x(c.a.x, c.b.x, c.c.x),
                  own.xy + along_x(k.a.y, k.b.y, k.c.y) + along_y(c.a.x, c.b.x, c.c.x),
                  own.xz + along_x(k.a.z, k.b.z, k.c.z) + along_z(c.a.x, c.b.x, c.c.x),
                  own.yy + along_y(k.a.y, k.b.y, k.c.y) + along_y(c.a.y, c.b.y, c.c.y),
                  own.yz + along_y(k.a.z, k.b.z, k.c.z) + along_z(c.a.y, c.b.y, c.c.y),
                  own.zz + along_z(k.a.z, k.b.z, k.c.z) + along_z(c.a.z, c.b.z, c.c.z)};
  rest.force = a.force + row.force_left * f;
  rest.moment = a.moment + row.force_left * m + cross(d, rest.force);

  if (row.adds_straight) {
    Articulated& parent = rows_[static_cast<std::size_t>(row.parent[0].row)].articulated;
    parent.linear = parent.linear + rest.linear;
    parent.angular = parent.angular + rest.angular;
    parent.coupling = parent.coupling + rest.coupling;
    parent.force = parent.force + rest.force;
    parent.moment = parent.moment + rest.moment;
    return;
  }
  for (int lane = 0; lane < (row.single ? 1 : 2); ++lane) {
    const Place parent = row.parent[static_cast<std::size_t>(lane)];
    Row& below = rows_[static_cast<std::size_t>(parent.row)];
    add_lane(rest, lane, below.articulated, parent.lane);
    if (below.single) add_lane(rest, lane, below.articulated, 1 - parent.lane);
  }
}

// [M H; Hᵀ I] (a; α) = −(force; moment), M eliminated.
void PairedBodies::accelerate_base(Eigen::Ref<Eigen::VectorXd> nu_dot) {
  const Articulated& base = rows_[0].articulated;
  const Matrix3d M_inverse = of_lane(base.linear, 0).inverse();
  Matrix3d H;
  H << of_lane(base.coupling.a, 0).transpose(), of_lane(base.coupling.b, 0).transpose(),
      of_lane(base.coupling.c, 0).transpose();
  const Vector3d force = of_lane(base.force, 0), moment = of_lane(base.moment, 0);
  const Matrix3d carried = H.transpose() * M_inverse;
  const Matrix3d about = of_lane(base.angular, 0) - carried * H;
  const Vector3d angular = about.inverse() * (carried * force - moment);
  const Vector3d linear = -(M_inverse * (force + H * angular));
  nu_dot.head<3>() = linear;
  nu_dot.segment<3>(3) = angular;
  for (int lane = 0; lane < 2; ++lane) {
    set_lane(rows_[0].acceleration.linear, lane, linear);
    set_lane(rows_[0].acceleration.angular, lane, angular);
  }
}

CODESIGN_BOTH_WIDTHS
bool PairedBodies::accelerate(const Eigen::Ref<const Eigen::VectorXd>& tau,
                              Eigen::Ref<Eigen::VectorXd> nu_dot) {
  for (std::size_t i = rows_.size() - 1; i > 0; --i) hand_down(rows_[i], tau.data());
  accelerate_base(nu_dot);
  for (std::size_t i = 1; i < rows_.size(); ++i) {
    Row& row = rows_[i];
    const Acceleration& first = rows_[static_cast<std::size_t>(row.parent[0].row)].acceleration;
    const Acceleration& second = rows_[static_cast<std::size_t>(row.parent[1].row)].acceleration;
    Acceleration mixed;
    if (!row.reads_straight) mixed = of_parents(row, first, second);
    const Acceleration& parent = row.reads_straight ? first : mixed;
    Acceleration& own = row.acceleration;
    own.linear = parent.linear + cross(parent.angular, row.offset);
    const Lanes joint = row.per_joint_inertia * (row.force_left - dot(row.joint_force, own.linear) -
                                                 dot(row.joint_moment, parent.angular));
    own.angular = parent.angular + (row.turns * joint) * row.motion.R.c;
    if (row.prismatic) own.linear = own.linear + (row.slides * joint) * row.motion.R.c;
    for (std::size_t lane = 0; lane < 2; ++lane) nu_dot[kBaseDofs + row.joint[lane]] = joint[lane];
  }
  return nu_dot.allFinite();
}

Matrix3d PairedBodies::rotation(int body) const {
  const Place place = places_[static_cast<std::size_t>(body)];
  const LaneMatrix& R = rows_[static_cast<std::size_t>(place.row)].motion.R;
  Matrix3d result;
  result << of_lane(R.a, place.lane), of_lane(R.b, place.lane), of_lane(R.c, place.lane);
  return result;
}

Vector3d PairedBodies::origin(int body) const {
  const Place place = places_[static_cast<std::size_t>(body)];
  return of_lane(rows_[static_cast<std::size_t>(place.row)].motion.p, place.lane);
}

Vector3d PairedBodies::linear_velocity(int body) const {
  const Place place = places_[static_cast<std::size_t>(body)];
  return of_lane(rows_[static_cast<std::size_t>(place.row)].motion.v, place.lane);
}

Vector3d PairedBodies::angular_velocity(int body) const {
  const Place place = places_[static_cast<std::size_t>(body)];
  return of_lane(rows_[static_cast<std::size_t>(place.row)].motion.w, place.lane);
}

Vector3d PairedBodies::center_of_mass() const {
  double mass = 0.0;
  Vector3d moment = Vector3d::Zero();
  for (const Row& row : rows_) {
    const LaneVector com = row.motion.p + combine(row.motion.R, row.com);
    for (int lane = 0; lane < (row.single ? 1 : 2); ++lane) {
      mass += row.mass[lane];
      moment += row.mass[lane] * of_lane(com, lane);
    }
  }
  return moment / mass;
}

void PairedBodies::push(int body, const Vector3d& force, const Vector3d& moment) {
  const Place place = places_[static_cast<std::size_t>(body)];
  Row& row = rows_[static_cast<std::size_t>(place.row)];
  for (int lane = 0; lane < 2; ++lane) {
    if (row.body[static_cast<std::size_t>(lane)] != body) continue;
    Articulated& own = row.articulated;
    set_lane(own.force, lane, of_lane(own.force, lane) - force);
    set_lane(own.moment, lane, of_lane(own.moment, lane) - moment);
  }
}

}  // namespace codesign::dynamics
