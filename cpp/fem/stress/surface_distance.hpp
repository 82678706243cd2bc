#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/mesh/tet_mesh.hpp"

namespace codesign::fem {

// Exact distance questions to a set of boundary triangles, or to the border of such a set. A
// six-node triangle counts as four flat ones, a border edge as two segments.
class SurfaceDistance {
 public:
  SurfaceDistance() = default;
  SurfaceDistance(const TetMesh& mesh, const std::vector<int>& triangles);

  // Border: edges of exactly one of the triangles.
  static SurfaceDistance to_border(const TetMesh& mesh, const std::vector<int>& triangles);

  // True if the point is not farther than distance (m).
  bool within(const Eigen::Vector3d& point, double distance) const;

 private:
  struct Piece {  // flat triangle; a segment has c == b
    Eigen::Vector3d a, b, c, center;
    double radius = 0.0;
  };
  void add(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);
  void sort_pieces();

  std::vector<Piece> pieces_;  // by center.x
  double max_radius_ = 0.0;
};

}  // namespace codesign::fem
