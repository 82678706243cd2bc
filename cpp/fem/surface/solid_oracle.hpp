#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "fem/surface/surface_mesh.hpp"

namespace codesign::fem {

// Answers geometric questions about the solid inside a closed surface: is a point inside, where
// does a segment meet the surface, what is the nearest point of the surface. Triangles sit in a
// tree of axis-parallel boxes. Edges are tested from both sides with the same arithmetic, so no
// segment slips between two triangles and no point is counted twice, without exact arithmetic.
class SolidOracle {
 public:
  // `group`: one label a triangle, for nearest_point. The surface must outlive the oracle.
  SolidOracle(const SurfaceMesh& surface, const std::vector<int>& group);

  struct Hit {
    Eigen::Vector3d point;
    int triangle;
  };

  // A point where the segment from a to b meets the surface, if any; of several, an arbitrary but
  // always the same one.
  std::optional<Hit> hit(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;

  // The first such point from a on, leaving out triangle `except` (-1: none).
  std::optional<Hit> first_hit(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                               int except) const;

  // The same of `candidates` only, which `in_box` gave: for many short segments in one box.
  std::optional<Hit> first_hit(const Eigen::Vector3d& a, const Eigen::Vector3d& b, int except,
                               const std::vector<int>& candidates) const;

  // The part within the (slightly enlarged) bounding box of the line base + s · direction, from
  // `first` to `last`, which may be infinite; empty if it misses the box.
  struct Piece {
    Eigen::Vector3d a, b;
  };
  std::optional<Piece> clip(const Eigen::Vector3d& base, const Eigen::Vector3d& direction,
                            double first, double last) const;

  // Whether p lies inside; on the surface, either answer.
  bool contains(const Eigen::Vector3d& p) const;

  // The triangles whose boxes meet the box from `lower` to `upper`.
  std::vector<int> in_box(const Eigen::Vector3d& lower, const Eigen::Vector3d& upper) const;

  // The nearest point of the triangles of one group; group -1 stands for all.
  Hit nearest(const Eigen::Vector3d& p, int group) const;

  // The nearest point closer than `within` of the triangles whose group is accepted, if any.
  std::optional<Hit> nearest_where(const Eigen::Vector3d& p, double within,
                                   const std::function<bool(int group)>& accepted) const;

  const Eigen::Vector3d& lower() const { return nodes_.front().lower; }
  const Eigen::Vector3d& upper() const { return nodes_.front().upper; }

 private:
  struct Node {
    Eigen::Vector3d lower, upper;
    int first;  // inner: index of the second child (the first one follows); leaf: first of order_
    int count;  // leaf: number of triangles; inner: 0
  };
  struct Corners {
    Eigen::Vector3d x[3];
  };

  void build(int first, int last, const std::vector<Eigen::Vector3d>& centers);
  static bool meets(const Eigen::Vector3d& p, const Corners& triangle);
  template <class Enter, class Visit>
  void traverse(Enter enter, Visit visit) const;

  std::vector<Node> nodes_;
  std::vector<int> order_;        // triangles in the order of the leaves
  std::vector<Corners> corners_;  // in the same order
  std::vector<int> group_;        // in the same order
  std::vector<int> place_;        // of each triangle in this order
};

}  // namespace codesign::fem
