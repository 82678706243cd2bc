#include "dynamics/spatial.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace codesign::dynamics {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d skew(const Vector3d& v) {
  Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

Vector3d skew_part(const Matrix3d& m) {
  return 0.5 * Vector3d(m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1));
}

Matrix3d exp_so3(const Vector3d& v) {
  const double angle2 = v.squaredNorm();
  double a = 1.0 - angle2 / 6.0;         // sin(x)/x
  double b = 0.5 - angle2 / 24.0;        // (1 - cos(x))/x²
  constexpr double kSeriesBelow = 1e-6;  // x² there: the next terms are below 1e-14
  if (angle2 > kSeriesBelow) {
    const double angle = std::sqrt(angle2);
    const double half = std::sin(0.5 * angle);
    a = std::sin(angle) / angle;
    b = 2.0 * half * half / angle2;
  } else {
    a += angle2 * angle2 / 120.0;
    b += angle2 * angle2 / 720.0;
  }
  Matrix3d R = a * skew(v);
  R.noalias() += b * (v * v.transpose());
  R.diagonal().array() += 1.0 - b * angle2;
  return R;
}

Vector3d log_so3(const Matrix3d& R) {
  // Through the unit quaternion, whose extraction is stable at every angle.
  const Eigen::Quaterniond quaternion(R);
  Vector3d v = quaternion.vec();
  double w = quaternion.w();
  if (w < 0.0) {
    v = -v;
    w = -w;
  }
  const double s = v.norm();
  constexpr double kTiny = 1e-8;
  const double factor = s < kTiny ? 2.0 / w : 2.0 * std::atan2(s, w) / s;
  return factor * v;
}

Matrix3d rpy_to_rotation(const Vector3d& rpy) {
  const double sr = std::sin(rpy.x()), cr = std::cos(rpy.x());
  const double sp = std::sin(rpy.y()), cp = std::cos(rpy.y());
  const double sy = std::sin(rpy.z()), cy = std::cos(rpy.z());
  Matrix3d R;
  R << cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr,  //
      sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr,   //
      -sp, cp * sr, cp * cr;
  return R;
}

Vector3d rotation_to_rpy(const Matrix3d& R) {
  const double cos_pitch = std::sqrt(R(2, 1) * R(2, 1) + R(2, 2) * R(2, 2));
  const double pitch = std::atan2(-R(2, 0), cos_pitch);
  constexpr double kGimbalLock = 1e-12;
  if (cos_pitch < kGimbalLock) return {0.0, pitch, std::atan2(-R(0, 1), R(1, 1))};
  return {std::atan2(R(2, 1), R(2, 2)), pitch, std::atan2(R(1, 0), R(0, 0))};
}

Vector3d angle_difference(const Vector3d& a, const Vector3d& b) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  Vector3d difference = a - b;
  for (double& angle : difference) angle -= kTurn * std::round(angle / kTurn);
  return difference;
}

double rotation_error(const Matrix3d& R) {
  if (!(R.determinant() > 0.0)) return 2.0;
  return (R.transpose() * R - Matrix3d::Identity()).cwiseAbs().maxCoeff();
}

Pose operator*(const Pose& a_T_b, const Pose& b_T_c) {
  return {a_T_b.R * b_T_c.R, a_T_b.p + a_T_b.R * b_T_c.p};
}

Pose inverse(const Pose& a_T_b) { return {a_T_b.R.transpose(), -(a_T_b.R.transpose() * a_T_b.p)}; }

RigidInertia transform(const Pose& a_T_b, const RigidInertia& body) {
  return {body.mass, a_T_b.p + a_T_b.R * body.com, a_T_b.R * body.inertia * a_T_b.R.transpose()};
}

RigidInertia operator+(const RigidInertia& a, const RigidInertia& b) {
  const double mass = a.mass + b.mass;
  if (!(mass > 0.0)) return {mass, a.com, a.inertia + b.inertia};
  const Vector3d d = b.com - a.com;
  const double reduced_mass = a.mass * (b.mass / mass);
  return {mass, a.com + (b.mass / mass) * d,
          a.inertia + b.inertia + point_inertia(reduced_mass, d)};
}

}  // namespace codesign::dynamics
