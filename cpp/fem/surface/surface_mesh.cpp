#include "fem/surface/surface_mesh.hpp"

#include <Eigen/Geometry>
#include <set>
#include <stdexcept>

#include "errors.hpp"

namespace codesign::fem {

void check_arrays(const SurfaceMesh& surface) {
  const Eigen::Index points = surface.points.rows();
  if (static_cast<Eigen::Index>(surface.face.size()) != surface.triangles.rows())
    throw std::invalid_argument("face: one entry per triangle is needed, got " +
                                std::to_string(surface.face.size()) + " for " +
                                std::to_string(surface.triangles.rows()) + " triangles");
  for (Eigen::Index i = 0; i < points; ++i)
    if (!surface.points.row(i).allFinite())
      throw MeshError("point " + std::to_string(i) + " has a coordinate that is not finite");
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t) {
    const Eigen::RowVector3i corners = surface.triangles.row(t);
    if (corners.minCoeff() < 0 || corners.maxCoeff() >= points)
      throw std::invalid_argument("triangles: row " + std::to_string(t) +
                                  " names a point outside 0.." + std::to_string(points - 1));
    const int face = surface.face[static_cast<std::size_t>(t)];
    if (face < 0 || face >= static_cast<int>(surface.face_names.size()))
      throw std::invalid_argument("face: entry " + std::to_string(t) + " is " +
                                  std::to_string(face) + ", outside face_names");
  }
  std::set<std::string> seen;
  for (const std::string& name : surface.face_names)
    if (!name.empty() && !seen.insert(name).second)
      throw std::invalid_argument("face_names: '" + name + "' appears twice");
}

Eigen::Vector3d corner(const SurfaceMesh& surface, Eigen::Index t, int k) {
  return surface.points.row(surface.triangles(t, k)).transpose();
}

namespace {

// Twice the area times the normal.
Eigen::Vector3d area_vector(const SurfaceMesh& surface, Eigen::Index t) {
  const Eigen::Vector3d a = corner(surface, t, 0);
  return (corner(surface, t, 1) - a).cross(corner(surface, t, 2) - a);
}

}  // namespace

Eigen::Vector3d triangle_normal(const SurfaceMesh& surface, Eigen::Index t) {
  const Eigen::Vector3d n = area_vector(surface, t);
  const double length = n.norm();
  return length > 0.0 ? Eigen::Vector3d(n / length) : Eigen::Vector3d::Zero();
}

double triangle_area(const SurfaceMesh& surface, Eigen::Index t) {
  return 0.5 * area_vector(surface, t).norm();
}

std::vector<double> face_areas(const SurfaceMesh& surface) {
  std::vector<double> areas(surface.face_names.size(), 0.0);
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t)
    areas[static_cast<std::size_t>(surface.face[static_cast<std::size_t>(t)])] +=
        triangle_area(surface, t);
  return areas;
}

double enclosed_volume(const SurfaceMesh& surface) {
  if (surface.points.rows() == 0) return 0.0;
  // Relative to the middle of the points: no cancellation for parts far from the origin.
  const Eigen::Vector3d origin = surface.points.colwise().mean().transpose();
  double six_volumes = 0.0;
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t) {
    const Eigen::Vector3d a = corner(surface, t, 0) - origin;
    const Eigen::Vector3d b = corner(surface, t, 1) - origin;
    const Eigen::Vector3d c = corner(surface, t, 2) - origin;
    six_volumes += a.dot(b.cross(c));
  }
  return six_volumes / 6.0;
}

double extent(const Points& points) {
  if (points.rows() == 0) return 0.0;
  return (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
}

}  // namespace codesign::fem
