#include "fem/meshing/size_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace codesign::fem {
namespace {

constexpr int kLeafSize = 8;
constexpr std::size_t kMaxDepth = 64;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

}  // namespace

SizePoints::SizePoints(std::vector<Eigen::Vector3d> points, std::vector<double> sizes,
                       double growth)
    : growth_(growth) {
  if (points.empty() || points.size() != sizes.size())
    throw std::invalid_argument("size points: one edge length for each point");
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  build(order, 0, static_cast<int>(order.size()), points, sizes);
  for (const int i : order) {
    points_.push_back(points[index(i)]);
    sizes_.push_back(sizes[index(i)]);
  }
}

// Splits at the median of the longest side of the box.
void SizePoints::build(std::vector<int>& order, int first, int last,
                       const std::vector<Eigen::Vector3d>& points,
                       const std::vector<double>& sizes) {
  const std::size_t at = nodes_.size();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Node node{Eigen::Vector3d::Constant(kInfinity), Eigen::Vector3d::Constant(-kInfinity), kInfinity,
            first, last - first};
  for (int i = first; i < last; ++i) {
    const std::size_t p = index(order[index(i)]);
    node.lower = node.lower.cwiseMin(points[p]);
    node.upper = node.upper.cwiseMax(points[p]);
    node.smallest = std::min(node.smallest, sizes[p]);
  }
  nodes_.push_back(node);
  if (last - first <= kLeafSize) return;
  int axis;
  (node.upper - node.lower).maxCoeff(&axis);
  const int middle = (first + last) / 2;
  std::nth_element(order.begin() + first, order.begin() + middle, order.begin() + last,
                   [&](int i, int j) {
                     const double x = points[index(i)][axis], y = points[index(j)][axis];
                     return x < y || (x == y && i < j);
                   });
  build(order, first, middle, points, sizes);
  nodes_[at].first = static_cast<int>(nodes_.size());
  nodes_[at].count = 0;
  build(order, middle, last, points, sizes);
}

SizePoints SizePoints::scaled(double factor) const {
  SizePoints other = *this;
  other.growth_ *= factor;
  for (Node& node : other.nodes_) node.smallest *= factor;
  for (double& size : other.sizes_) size *= factor;
  return other;
}

double SizePoints::size_at(const Eigen::Vector3d& p, double cap) const {
  std::array<int, kMaxDepth> stack;
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const int at = stack[--depth];
    const Node& node = nodes_[index(at)];
    if (node.smallest >= cap) continue;
    const double reach = (cap - node.smallest) / growth_;  // farther points cannot lower the cap
    if ((p - p.cwiseMax(node.lower).cwiseMin(node.upper)).squaredNorm() >= reach * reach) continue;
    if (node.count == 0) {
      stack[depth++] = node.first;
      stack[depth++] = at + 1;
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i)
      cap = std::min(cap, sizes_[index(i)] + growth_ * (points_[index(i)] - p).norm());
  }
  return cap;
}

}  // namespace codesign::fem
