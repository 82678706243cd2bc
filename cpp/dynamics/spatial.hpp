#pragma once

#include <Eigen/Core>

// Rotations, poses and rigid-body inertias as plain values and free functions.
// Names read a_T_b, a_R_b: pose and rotation of b in a, taking b-coordinates to a.
// Six-vectors stack the linear part first.
namespace codesign::dynamics {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Matrix6Xd = Eigen::Matrix<double, 6, Eigen::Dynamic>;

// The matrix S(v) with S(v) x = v × x.
Eigen::Matrix3d skew(const Eigen::Vector3d& v);

// Axial vector of the skew part of a matrix: skew_part(S(v)) = v.
Eigen::Vector3d skew_part(const Eigen::Matrix3d& m);

// Rotation by the angle |v| [rad] about v (Rodrigues' formula); exact to rounding for tiny |v| too.
Eigen::Matrix3d exp_so3(const Eigen::Vector3d& v);

// The rotation vector v, |v| ≤ π, with exp_so3(v) = R. Accurate near 0 and near π.
Eigen::Vector3d log_so3(const Eigen::Matrix3d& R);

// R = Rz(yaw) Ry(pitch) Rx(roll): the fixed-axis angles of URDF, (roll, pitch, yaw) [rad].
Eigen::Matrix3d rpy_to_rotation(const Eigen::Vector3d& rpy);

// The inverse, pitch within [-π/2, π/2]; at a pitch of ±π/2 the roll is set to zero.
Eigen::Vector3d rotation_to_rpy(const Eigen::Matrix3d& R);

// a − b, each entry within a half turn [rad].
Eigen::Vector3d angle_difference(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

// Largest entry of |RᵀR - 1|, or 2 if R is a reflection: how far R is from a rotation.
double rotation_error(const Eigen::Matrix3d& R);

// Pose a_T_b: rotation a_R_b and the origin of b in a.
struct Pose {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p = Eigen::Vector3d::Zero();  // [m]
};

// a_T_c, and b_T_a of a_T_b.
Pose operator*(const Pose& a_T_b, const Pose& b_T_c);
Pose inverse(const Pose& a_T_b);

// Mass [kg], center of mass [m] and inertia about the center of mass [kg m²], in one frame's axes.
struct RigidInertia {
  double mass = 0.0;
  Eigen::Vector3d com = Eigen::Vector3d::Zero();
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
};

// Inertia m (|d|² 1 - d dᵀ) of a point mass about a point at distance d [kg m²]; exactly symmetric.
inline Eigen::Matrix3d point_inertia(double mass, const Eigen::Vector3d& d) {
  const double x = mass * d.x(), y = mass * d.y(), z = mass * d.z();
  const double xx = x * d.x(), yy = y * d.y(), zz = z * d.z();
  const double xy = -x * d.y(), xz = -x * d.z(), yz = -y * d.z();
  Eigen::Matrix3d inertia;
  inertia << yy + zz, xy, xz, xy, zz + xx, yz, xz, yz, xx + yy;
  return inertia;
}

// The same body seen from frame a.
RigidInertia transform(const Pose& a_T_b, const RigidInertia& body);

// Two bodies of one frame, rigidly joined. Exact for massless bodies.
RigidInertia operator+(const RigidInertia& a, const RigidInertia& b);

}  // namespace codesign::dynamics
