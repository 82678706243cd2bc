#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "fem/smoothing/smooth_normals.hpp"

namespace codesign::fem {

// Cubic Bézier curve that replaces an edge of a coarse surface.
struct EdgeArc {
  std::array<int, 2> ends;                 // points, the smaller index first
  std::array<Eigen::Vector3d, 4> control;  // m; on the chord if straight
  int halvings = 0;                        // it is cut into 2^halvings pieces; 0: straight
  Eigen::Vector3d at(double x) const;      // 0 <= x <= 1 from the first end, m
};

// The curves of all edges of a surface.
struct EdgeArcs {
  std::vector<EdgeArc> arcs;
  std::vector<std::array<int, 3>> of_triangle;  // (m) arc of the edge from corner k
};

// The curve of every edge, from nothing but the edge's ends, their normals on both sides and, where
// a flat runs smoothly into a curved face, the next points of that border. Smooth edges end in the
// tangent planes, sharp ones in the intersection of both sides'. An edge of a triangle of which
// `literal` holds is straight, as is one whose ends contradict each other or turn by more than
// feature_angle [rad]. Arms of 2 c / (3 (1 + cos a)) for a chord c and an angle a to it make
// circular arcs (1e-5 of the radius up to 45 degrees).
EdgeArcs find_edge_arcs(const SurfaceMesh& surface, const SmoothNormals& normals,
                        const std::vector<bool>& literal, double feature_angle);

// Whether a piece of a curve that turns by `turn` [rad] over `length` [m] is to be halved.
bool too_coarse(double turn, double length, double extent);

}  // namespace codesign::fem
