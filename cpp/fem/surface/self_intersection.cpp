// The only file that sees CGAL's intersection tests.
#include "fem/surface/self_intersection.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "errors.hpp"

namespace codesign::fem {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Polyhedron = CGAL::Surface_mesh<Kernel::Point_3>;

Kernel::Point_3 exact(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

std::string center(const SurfaceMesh& surface, Eigen::Index t) {
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
                      " at " + center(surface, t));
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
  if (a == b)
    throw MeshError("triangle " + std::to_string(a) + " at " + center(surface, a) +
                    " has no area: its corners lie on one line");
  throw MeshError("the surface crosses itself: triangle " + std::to_string(a) + " at " +
                  center(surface, a) + " and triangle " + std::to_string(b) + " at " +
                  center(surface, b));
}

bool is_degenerate(const Facet& facet) {
  return CGAL::collinear(exact(facet.at[0]), exact(facet.at[1]), exact(facet.at[2]));
}

bool facets_cross(const Facet& s, const Facet& t) {
  // Positions in s and t of the corners of one that the other has not, and of a common corner.
  std::vector<std::size_t> only_s, only_t;
  std::size_t common = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (std::count(t.point.begin(), t.point.end(), s.point[k]) == 0)
      only_s.push_back(k);
    else
      common = k;
    if (std::count(s.point.begin(), s.point.end(), t.point[k]) == 0) only_t.push_back(k);
  }
  const auto triangle = [](const Facet& f) {
    return Kernel::Triangle_3(exact(f.at[0]), exact(f.at[1]), exact(f.at[2]));
  };
  const auto opposite_edge = [](const Facet& f, const std::vector<std::size_t>& ends) {
    return Kernel::Segment_3(exact(f.at[ends[0]]), exact(f.at[ends[1]]));
  };
  switch (only_s.size()) {
    case 3:
      return CGAL::do_intersect(triangle(s), triangle(t));
    case 2:  // beside the common corner they meet where the far edge of one meets the other
      return CGAL::do_intersect(opposite_edge(s, only_s), triangle(t)) ||
             CGAL::do_intersect(opposite_edge(t, only_t), triangle(s));
    case 1: {  // folded flat onto each other about the common edge
      const auto a = exact(s.at[common]), b = exact(s.at[3 - common - only_s[0]]);
      const auto p = exact(s.at[only_s[0]]), q = exact(t.at[only_t[0]]);
      return CGAL::coplanar(a, b, p, q) && CGAL::coplanar_orientation(a, b, p, q) == CGAL::POSITIVE;
    }
    default:
      return true;  // the same three corners
  }
}

}  // namespace codesign::fem
