#pragma once

#include <cstddef>

namespace codesign::fem {

inline constexpr double kDegree = 3.14159265358979323846 / 180.0;  // rad

// What a mesh shall be like, and when meshing gives up.
struct MeshOptions {
  double feature_angle = 40.0 * kDegree;   // edges sharper than this are kept, rad
  double simplify = 5e-5;                  // points may move this far to get rid of tiny edges, m
  double facet_distance = 0.06;            // of boundary sides to the surface, relative to the size
  double facet_angle = 25.0 * kDegree;     // smallest angle of a boundary side, rad
  double radius_edge = 2.5;                // largest circumradius / shortest edge of a tetrahedron
  double sliver_angle = 12.0 * kDegree;    // elements flatter than this are improved, rad
  double flat_angle = 6.0 * kDegree;       // boundary elements flatter than this are peeled, rad
  bool curved = true;                      // mid-edge nodes of the boundary on the surface
  std::size_t max_questions = 25'000'000;  // of the refinement about the solid and the size
  double time_limit = 300.0;               // processor time of this thread, s: a safety net
  std::size_t max_vertices = 400'000;      // corner nodes
  bool check_intersections = true;         // look for triangles that cross each other first
  int topology_rounds = 5;                 // of refinement where another topology was found
  bool measure_distance = true;            // between boundary and surface, for the report
};

}  // namespace codesign::fem
