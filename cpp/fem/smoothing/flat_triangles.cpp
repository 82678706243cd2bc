// The only file that sees CGAL's plane triangulations.
#include "fem/smoothing/flat_triangles.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <Eigen/Geometry>
#include <cmath>
#include <unordered_map>

namespace codesign::fem {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure,
                                               CGAL::No_constraint_intersection_tag>;
using Face = Triangulation::Face_handle;

constexpr double kSameArea = 1e-6;  // relative, of the triangles and of the outline around them

// Faces inside: as many constraints away from the infinite face as is odd.
std::vector<Face> inner_faces(const Triangulation& triangulation) {
  std::unordered_map<Face, int, CGAL::Handle_hash_function> depth;
  std::vector<Face> now{triangulation.infinite_face()}, next, inside;
  depth[now.front()] = 0;
  for (int level = 0; !now.empty(); ++level) {
    next.clear();
    for (std::size_t i = 0; i < now.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        const Face other = now[i]->neighbor(k);
        if (depth.count(other)) continue;
        const bool crossed = triangulation.is_constrained({now[i], k});
        if (!crossed) depth[other] = level;
        (crossed ? next : now).push_back(other);
      }
    if (level % 2 == 1) inside.insert(inside.end(), now.begin(), now.end());
    now.clear();
    for (const Face& face : next)
      if (depth.try_emplace(face, level + 1).second) now.push_back(face);
  }
  return inside;
}

}  // namespace

std::optional<std::vector<std::array<int, 3>>> triangulate_flat(
    const std::vector<Eigen::Vector3d>& points, const std::vector<std::pair<int, int>>& outline,
    const std::vector<int>& inside, const Eigen::Vector3d& normal) {
  const Eigen::Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
  const auto at = [&](int p) -> const Eigen::Vector3d& {
    return points[static_cast<std::size_t>(p)];
  };
  const Eigen::Vector3d origin = at(outline.front().first);
  const auto flat = [&](int p) {
    const Eigen::Vector3d d = at(p) - origin;
    return Eigen::Vector2d(d.dot(u), d.dot(v));
  };
  Triangulation triangulation;
  std::unordered_map<int, Triangulation::Vertex_handle> vertex;
  const auto insert = [&](int p) {
    if (vertex.count(p)) return;
    const Eigen::Vector2d x = flat(p);
    const auto handle = triangulation.insert({x.x(), x.y()});
    handle->info() = p;
    vertex[p] = handle;
  };
  double wanted = 0.0, found = 0.0;
  for (const auto& [a, b] : outline) {
    insert(a);
    insert(b);
    wanted += 0.5 * (flat(a).x() * flat(b).y() - flat(b).x() * flat(a).y());
  }
  for (const int p : inside) insert(p);
  if (triangulation.number_of_vertices() != vertex.size()) return {};  // two points in one place
  try {
    for (const auto& [a, b] : outline) triangulation.insert_constraint(vertex[a], vertex[b]);
  } catch (const Triangulation::Intersection_of_constraints_exception&) {
    return {};
  }
  for (const auto& [a, b] : outline)
    if (!triangulation.is_edge(vertex[a], vertex[b])) return {};  // it passes through a point
  std::vector<std::array<int, 3>> triangles;
  for (const Face& face : inner_faces(triangulation)) {
    if (triangulation.is_infinite(face)) return {};
    triangles.push_back(
        {face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
    const auto& [a, b, c] = triangles.back();
    const Eigen::Vector2d ab = flat(b) - flat(a), ac = flat(c) - flat(a);
    found += 0.5 * (ab.x() * ac.y() - ab.y() * ac.x());
  }
  if (std::abs(found - wanted) > kSameArea * wanted) return {};
  return triangles;
}

}  // namespace codesign::fem
