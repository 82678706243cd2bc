#include "fem/surface/mass_properties.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>

#include "fem/surface/surface_check.hpp"

namespace codesign::fem {

MassProperties mass_properties(const SurfaceMesh& surface, double density) {
  if (!(density > 0.0) || !std::isfinite(density))
    throw std::invalid_argument("density: a positive number of kg/m³ is needed");
  check_surface(surface);

  // Apex in the middle of the points: no cancellation for parts far from the origin.
  const Eigen::Vector3d apex = surface.points.colwise().mean().transpose();
  double volume = 0.0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();   // integral of x - apex
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  // integral of (x - apex)(x - apex)ᵀ
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t) {
    const Eigen::Vector3d a = corner(surface, t, 0) - apex;
    const Eigen::Vector3d b = corner(surface, t, 1) - apex;
    const Eigen::Vector3d c = corner(surface, t, 2) - apex;
    const double v = a.dot(b.cross(c)) / 6.0;
    const Eigen::Vector3d s = a + b + c;
    volume += v;
    first += v / 4.0 * s;
    // Over a tetrahedron with corners 0, a, b, c: ∫ x xᵀ = V/20 (a aᵀ + b bᵀ + c cᵀ + s sᵀ).
    second +=
        v / 20.0 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose());
  }
  const Eigen::Vector3d center = first / volume;
  const Eigen::Matrix3d central = second - volume * center * center.transpose();
  MassProperties properties;
  properties.volume = volume;
  properties.mass = density * volume;
  properties.com = apex + center;
  properties.inertia = density * (central.trace() * Eigen::Matrix3d::Identity() - central);
  return properties;
}

}  // namespace codesign::fem
