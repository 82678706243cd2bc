#include "fem/boundary/primitive.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace codesign::fem {

namespace {

constexpr std::size_t kMostPoints = 400;  // of a refinement; more are thinned out
constexpr int kIterations = 20;

using Parameters = Eigen::Matrix<double, 6, 1>;  // turns of the axis (2), moves (2), radius, slope

std::vector<Eigen::Vector3d> thinned(const std::vector<Eigen::Vector3d>& points) {
  const std::size_t step = points.size() / kMostPoints + 1;
  std::vector<Eigen::Vector3d> result;
  for (std::size_t i = 0; i < points.size(); i += step) result.push_back(points[i]);
  return result;
}

// The primitive with its axis turned and moved by the parameters.
Primitive moved(const Primitive& p, const Parameters& by, double length) {
  const Eigen::Vector3d u = p.axis.unitOrthogonal(), v = p.axis.cross(u);
  Primitive result = p;
  result.axis = (p.axis + by[0] * u + by[1] * v).normalized();
  result.point = p.point + length * (by[2] * u + by[3] * v);
  result.radius = p.radius + length * by[4];
  result.slope = p.slope + by[5];
  return result;
}

Eigen::VectorXd residuals(const Primitive& p, const std::vector<Eigen::Vector3d>& points) {
  Eigen::VectorXd r(static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    r[static_cast<Eigen::Index>(i)] = p.distance(points[i]);
  }
  return r;
}

// Levenberg-Marquardt on the distances of the points; without `sloped` the slope stays.
Primitive refined(Primitive p, const std::vector<Eigen::Vector3d>& points, double length,
                  bool sloped) {
  const Eigen::Index free = sloped ? 6 : 5;
  double damping = 1e-3;
  Eigen::VectorXd r = residuals(p, points);
  for (int i = 0; i < kIterations; ++i) {
    Eigen::MatrixXd jacobian(r.size(), free);
    for (Eigen::Index k = 0; k < free; ++k) {
      constexpr double kStep = 1e-6;
      Parameters step = Parameters::Zero();
      step[k] = kStep;
      jacobian.col(k) = (residuals(moved(p, step, length), points) - r) / kStep;
    }
    const Eigen::MatrixXd normal = jacobian.transpose() * jacobian;
    const Eigen::VectorXd gradient = jacobian.transpose() * r;
    Eigen::MatrixXd damped = normal;
    damped.diagonal() *= 1.0 + damping;
    damped.diagonal().array() += 1e-12 * normal.trace();
    Parameters step = Parameters::Zero();
    step.head(free) = -damped.ldlt().solve(gradient);
    const Primitive next = moved(p, step, length);
    const Eigen::VectorXd there = residuals(next, points);
    if (there.allFinite() && there.squaredNorm() < r.squaredNorm()) {
      const bool settled = there.norm() > (1.0 - 1e-6) * r.norm();
      p = next;
      r = there;
      damping *= 0.1;
      if (settled) break;
    } else if ((damping *= 10.0) > 1e6) {
      break;
    }
  }
  return p;
}

// Circle through the points projected along the axis (least squares of |x|² = 2 c x + d).
bool set_circle(const std::vector<Eigen::Vector3d>& points, Primitive& p) {
  const Eigen::Vector3d u = p.axis.unitOrthogonal(), v = p.axis.cross(u), origin = p.point;
  Eigen::MatrixXd a(static_cast<Eigen::Index>(points.size()), 3);
  Eigen::VectorXd b(a.rows());
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    const Eigen::Vector3d x = points[static_cast<std::size_t>(i)] - origin;
    a.row(i) << x.dot(u), x.dot(v), 1.0;
    b[i] = a(i, 0) * a(i, 0) + a(i, 1) * a(i, 1);
  }
  const Eigen::Vector3d c = a.colPivHouseholderQr().solve(b);
  const double square = c[2] + 0.25 * (c[0] * c[0] + c[1] * c[1]);
  if (!c.allFinite() || !(square > 0)) return false;
  p.point = origin + 0.5 * (c[0] * u + c[1] * v);
  p.radius = std::sqrt(square);
  return true;
}

// Point of the axis nearest to the lines along the normals, and radius and slope of the generatrix
// by linear regression over the points.
bool set_generatrix(const FitData& data, Primitive& p) {
  const Eigen::Vector3d u = p.axis.unitOrthogonal(), v = p.axis.cross(u), origin = p.point;
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < data.normals.size(); ++i) {
    const Eigen::Vector3d across = data.normals[i].cross(p.axis);
    const Eigen::Vector2d row(u.dot(across), v.dot(across));
    normal += data.areas[i] * row * row.transpose();
    right += data.areas[i] * row * (data.centroids[i] - origin).dot(across);
  }
  const Eigen::Vector2d move = normal.ldlt().solve(right);
  if (!move.allFinite()) return false;
  p.point = origin + move[0] * u + move[1] * v;
  Eigen::Matrix2d moments = Eigen::Matrix2d::Zero();
  right.setZero();
  for (const Eigen::Vector3d& x : data.points) {
    const Eigen::Vector3d r = x - p.point;
    const double z = r.dot(p.axis), rho = (r - z * p.axis).norm();
    const Eigen::Vector2d row(1.0, z);
    moments += row * row.transpose();
    right += rho * row;
  }
  const Eigen::Vector2d line = moments.ldlt().solve(right);
  p.radius = line[0];
  p.slope = line[1];
  return line.allFinite();
}

struct Bounds {
  explicit Bounds(const std::vector<Eigen::Vector3d>& points) {
    lower = upper = points.front();
    for (const Eigen::Vector3d& x : points) {
      lower = lower.cwiseMin(x);
      upper = upper.cwiseMax(x);
    }
  }
  Eigen::Vector3d center() const { return 0.5 * (lower + upper); }
  double size() const { return (upper - lower).norm(); }
  Eigen::Vector3d lower, upper;
};

// Second moments of the normals about `about`, and so the direction they vary least along.
Eigen::Vector3d least_direction(const FitData& data, const Eigen::Vector3d& about) {
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < data.normals.size(); ++i) {
    const Eigen::Vector3d n = data.normals[i] - about;
    moments += data.areas[i] * n * n.transpose();
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments).eigenvectors().col(0);
}

}  // namespace

std::string surface_type_name(SurfaceType type) {
  constexpr const char* kNames[] = {"plane", "cylinder", "cone", "sphere", "free"};
  return kNames[static_cast<int>(type)];
}

double Primitive::distance(const Eigen::Vector3d& x) const {
  const Eigen::Vector3d r = x - point;
  if (type == SurfaceType::plane) return r.dot(axis);
  if (type == SurfaceType::sphere) return r.norm() - radius;
  const double z = r.dot(axis), rho = (r - z * axis).norm();
  return (rho - radius - slope * z) / std::sqrt(1.0 + slope * slope);
}

Eigen::Vector3d Primitive::normal(const Eigen::Vector3d& x) const {
  if (type == SurfaceType::plane) return axis;
  const Eigen::Vector3d r = x - point;
  if (type == SurfaceType::sphere) return r.normalized();
  return ((r - r.dot(axis) * axis).normalized() - slope * axis).normalized();
}

Primitive fit_sphere(const FitData& data) {
  Primitive p;
  if (data.points.size() < 4) return p;
  const std::vector<Eigen::Vector3d> points = thinned(data.points);
  const Bounds bounds(points);
  Eigen::MatrixXd a(static_cast<Eigen::Index>(points.size()), 4);
  Eigen::VectorXd b(a.rows());
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    const Eigen::Vector3d x = points[static_cast<std::size_t>(i)] - bounds.center();
    a.row(i) << x.transpose(), bounds.size();
    b[i] = x.squaredNorm();
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factor(a);
  if (factor.rank() < 4) return p;
  const Eigen::Vector4d c = factor.solve(b);
  const double square = c[3] * bounds.size() + 0.25 * c.head<3>().squaredNorm();
  if (!c.allFinite() || !(square > 0)) return p;
  p.type = SurfaceType::sphere;
  p.point = bounds.center() + 0.5 * c.head<3>();
  p.radius = std::sqrt(square);
  return p;
}

Primitive fit_cylinder(const FitData& data) {
  Primitive p;
  if (data.points.size() < 6) return p;
  const std::vector<Eigen::Vector3d> points = thinned(data.points);
  const Bounds bounds(points);
  p.point = bounds.center();
  p.axis = least_direction(data, Eigen::Vector3d::Zero());
  if (!set_circle(points, p)) return p;
  p.type = SurfaceType::cylinder;
  return refined(p, points, bounds.size(), false);
}

// The normals of a cone end on a circle around its axis; their lines meet the axis.
Primitive fit_cone(const FitData& data) {
  Primitive p;
  if (data.points.size() < 6) return p;
  const std::vector<Eigen::Vector3d> points = thinned(data.points);
  const Bounds bounds(points);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double total = 0.0;
  for (std::size_t i = 0; i < data.normals.size(); ++i) {
    mean += data.areas[i] * data.normals[i];
    total += data.areas[i];
  }
  p.point = bounds.center();
  p.axis = least_direction(data, mean / total);
  if (!set_generatrix(data, p)) return p;
  p.type = SurfaceType::cone;
  return refined(p, points, bounds.size(), true);
}

}  // namespace codesign::fem
