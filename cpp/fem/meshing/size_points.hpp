#pragma once

#include <Eigen/Core>
#include <vector>

namespace codesign::fem {

// Many points with an edge length each, which grows with the distance from the point: the edge
// length anywhere is the smallest of them all. Points sit in a tree of boxes.
class SizePoints {
 public:
  // `points` and `sizes` [m] of equal, positive length; growth: per meter of distance.
  SizePoints(std::vector<Eigen::Vector3d> points, std::vector<double> sizes, double growth);

  // The edge length at p, or `cap` if that is smaller. [m]
  double size_at(const Eigen::Vector3d& p, double cap) const;

  // All edge lengths times a factor, at every point.
  SizePoints scaled(double factor) const;

  double smallest() const { return nodes_.front().smallest; }

 private:
  struct Node {
    Eigen::Vector3d lower, upper;
    double smallest;  // edge length of its points
    int first;        // inner: index of the second child (the first one follows); leaf: first point
    int count;        // leaf: number of points; inner: 0
  };

  struct Item {
    Eigen::Vector3d point;
    double size;
    int index;  // as given
  };

  void build(std::vector<Item>& items, int first, int last);

  std::vector<Node> nodes_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<double> sizes_;
  double growth_;
};

}  // namespace codesign::fem
