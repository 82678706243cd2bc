#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "fem/mesh/tet_mesh.hpp"

namespace codesign::fem {

// Exact distance questions to pieces of a mesh's surface, each with a reach (m) of its own: the
// distance that is kept from it. A six-node triangle counts as four flat ones, an edge as two
// segments.
class SurfaceDistance {
 public:
  SurfaceDistance() = default;

  // All with the same reach.
  SurfaceDistance(const TetMesh& mesh, const std::vector<int>& triangles, double reach = 0.0);

  void add_triangle(const TetMesh& mesh, int triangle, double reach);
  // The edge from corner k to corner k + 1 of a boundary triangle.
  void add_edge(const TetMesh& mesh, int triangle, int k, double reach);
  // To be called after the last addition and before any question.
  void sort_pieces();

  // True if the point is not farther from a piece than its reach enlarged by `more` (m).
  bool within(const Eigen::Vector3d& point, double more = 0.0) const;

  // From the nearest piece; infinite if there is none. [m]
  double distance(const Eigen::Vector3d& point) const;

  bool empty() const { return pieces_.empty(); }
  double smallest_reach() const;  // 0 if empty
  double largest_reach() const;

 private:
  struct Piece {  // flat triangle; a segment has c == b
    Eigen::Vector3d a, b, c;
    Eigen::Vector3d normal;  // unit; zero of a segment
  };
  struct Ball {  // around a piece
    Eigen::Vector3d center;
    double radius = 0.0, reach = 0.0;
    int piece = 0;
  };
  void add(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
           double reach);

  bool reaches(const Ball& ball, const Eigen::Vector3d& point, double more) const;
  Eigen::Array3i cell(const Eigen::Vector3d& point) const;  // the nearest of the grid
  std::size_t number(const Eigen::Array3i& cell) const;

  std::vector<Piece> pieces_;
  std::vector<Ball> balls_;      // by cell of a grid over their centers, those along x in a row
  std::vector<int> first_;       // (cells + 1) of balls_
  Eigen::AlignedBox3d centers_;  // box around them
  double edge_ = 1.0;            // of a cell [m]
  Eigen::Array3i cells_ = Eigen::Array3i::Ones();
  double max_extent_ = 0.0;  // of radius + reach
};

}  // namespace codesign::fem
