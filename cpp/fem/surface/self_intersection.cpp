// The only file that sees CGAL's intersection tests.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <cstdio>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "errors.hpp"
#include "fem/surface/surface_check.hpp"

namespace codesign::fem {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Polyhedron = CGAL::Surface_mesh<Kernel::Point_3>;

std::string centre(const SurfaceMesh& surface, Eigen::Index t) {
  const Eigen::Vector3d p =
      (corner(surface, t, 0) + corner(surface, t, 1) + corner(surface, t, 2)) / 3.0;
  char text[96];
  std::snprintf(text, sizeof text, "(%.6g, %.6g, %.6g) m", p.x(), p.y(), p.z());
  return text;
}

}  // namespace

std::vector<std::pair<int, int>> crossing_triangles(const SurfaceMesh& surface, int most) {
  Polyhedron polyhedron;
  std::vector<Polyhedron::Vertex_index> vertex;
  for (Eigen::Index i = 0; i < surface.points.rows(); ++i)
    vertex.push_back(
        polyhedron.add_vertex({surface.points(i, 0), surface.points(i, 1), surface.points(i, 2)}));
  const auto at = [&](int i) { return vertex[static_cast<std::size_t>(i)]; };
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t) {
    const auto face = polyhedron.add_face(at(surface.triangles(t, 0)), at(surface.triangles(t, 1)),
                                          at(surface.triangles(t, 2)));
    if (face == Polyhedron::null_face())
      throw MeshError("the surface touches itself in a point near triangle " + std::to_string(t) +
                      " at " + centre(surface, t));
  }
  using Face = Polyhedron::Face_index;
  std::vector<std::pair<Face, Face>> crossing;
  CGAL::Polygon_mesh_processing::self_intersections<CGAL::Sequential_tag>(
      polyhedron, std::back_inserter(crossing), CGAL::parameters::maximum_number(most));
  std::vector<std::pair<int, int>> pairs;
  for (const auto& [a, b] : crossing)
    pairs.emplace_back(static_cast<int>(a.idx()), static_cast<int>(b.idx()));
  return pairs;
}

void check_self_intersection(const SurfaceMesh& surface) {
  const auto crossing = crossing_triangles(surface, 1);
  if (crossing.empty()) return;
  const auto [a, b] = crossing.front();
  throw MeshError("the surface crosses itself: triangle " + std::to_string(a) + " at " +
                  centre(surface, a) + " and triangle " + std::to_string(b) + " at " +
                  centre(surface, b));
}

}  // namespace codesign::fem
