#include "fem/meshing/size_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
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
  std::vector<Item> items;
  items.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    items.push_back({points[i], sizes[i], static_cast<int>(i)});
  build(items, 0, static_cast<int>(items.size()));
  points_.reserve(items.size());
  sizes_.reserve(items.size());
  for (const Item& item : items) {
    points_.push_back(item.point);
    sizes_.push_back(item.size);
  }
}

// Splits at the median of the longest side of the box.
void SizePoints::build(std::vector<Item>& items, int first, int last) {
  const std::size_t at = nodes_.size();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Node node{Eigen::Vector3d::Constant(kInfinity), Eigen::Vector3d::Constant(-kInfinity), kInfinity,
            first, last - first};
  for (int i = first; i < last; ++i) {
    const Item& item = items[index(i)];
    node.lower = node.lower.cwiseMin(item.point);
    node.upper = node.upper.cwiseMax(item.point);
    node.smallest = std::min(node.smallest, item.size);
  }
  nodes_.push_back(node);
  if (last - first <= kLeafSize) return;
  int axis;
  (node.upper - node.lower).maxCoeff(&axis);
  const int middle = (first + last) / 2;
  std::nth_element(items.begin() + first, items.begin() + middle, items.begin() + last,
                   [axis](const Item& a, const Item& b) {
                     const double x = a.point[axis], y = b.point[axis];
                     return x < y || (x == y && a.index < b.index);
                   });
  build(items, first, middle);
  nodes_[at].first = static_cast<int>(nodes_.size());
  nodes_[at].count = 0;
  build(items, middle, last);
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
