#include "fem/surface/solid_oracle.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace codesign::fem {
namespace {

using Eigen::Vector3d;

constexpr int kLeafSize = 4;
constexpr int kMaxDepth = 64;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A segment prepared for tests against boxes and triangles. Triangles are sheared so that the
// segment lies on the third axis; the signs of the three edge functions in the first two axes then
// tell whether it passes through. Source: Woop, Benthin, Wald, "Watertight ray/triangle
// intersection", JCGT 2 (2013).
struct Ray {
  Vector3d origin, direction, inverse;
  int kx, ky, kz;
  double sx, sy, sz;

  Ray(const Vector3d& a, const Vector3d& b) : origin(a), direction(b - a) {
    direction.cwiseAbs().maxCoeff(&kz);
    kx = (kz + 1) % 3;
    ky = (kz + 2) % 3;
    sx = direction[kx] / direction[kz];
    sy = direction[ky] / direction[kz];
    sz = 1.0 / direction[kz];
    inverse = direction.cwiseInverse();
  }

  bool enters(const Vector3d& lower, const Vector3d& upper) const {
    double first = 0.0, last = 1.0;
    for (int k = 0; k < 3; ++k) {
      if (direction[k] == 0.0) {
        if (origin[k] < lower[k] || origin[k] > upper[k]) return false;
        continue;
      }
      const double s = (lower[k] - origin[k]) * inverse[k];
      const double t = (upper[k] - origin[k]) * inverse[k];
      first = std::max(first, std::min(s, t));
      last = std::min(last, std::max(s, t));
    }
    return first <= last + 1e-12;  // rounding of the divisions
  }

  bool crosses(const Vector3d (&x)[3], Vector3d& point) const {
    double u[3], v[3], w[3];
    for (int i = 0; i < 3; ++i) {
      const double z = x[i][kz] - origin[kz];
      u[i] = x[i][kx] - origin[kx] - sx * z;
      v[i] = x[i][ky] - origin[ky] - sy * z;
      w[i] = z * sz;
    }
    const double e0 = u[2] * v[1] - v[2] * u[1];
    const double e1 = u[0] * v[2] - v[0] * u[2];
    const double e2 = u[1] * v[0] - v[1] * u[0];
    if ((e0 < 0.0 || e1 < 0.0 || e2 < 0.0) && (e0 > 0.0 || e1 > 0.0 || e2 > 0.0)) return false;
    const double sum = e0 + e1 + e2;
    if (sum == 0.0) return false;
    const double t = (e0 * w[0] + e1 * w[1] + e2 * w[2]) / sum;
    if (!(t >= 0.0 && t <= 1.0)) return false;
    point = (e0 * x[0] + e1 * x[1] + e2 * x[2]) / sum;
    return true;
  }
};

// The crossing nearest to the start of a segment; of equally near ones, the first offered.
struct Nearest {
  Vector3d start, point = Vector3d::Zero();
  double distance = kInfinity;  // squared
  int triangle = -1;

  void offer(const Ray& ray, const Vector3d (&corners)[3], int t) {
    Vector3d crossing;
    if (!ray.crosses(corners, crossing)) return;
    const double d = (crossing - start).squaredNorm();
    if (!(d < distance)) return;
    distance = d;
    point = crossing;
    triangle = t;
  }

  std::optional<SolidOracle::Hit> hit() const {
    if (triangle < 0) return {};
    return SolidOracle::Hit{point, triangle};
  }
};

double squared_distance(const Vector3d& p, const Vector3d& lower, const Vector3d& upper) {
  return (p - p.cwiseMax(lower).cwiseMin(upper)).squaredNorm();
}

// Nearest point of a triangle: by the Voronoi region of its corners, edges and face that p lies in.
// Source: C. Ericson, Real-Time Collision Detection, section 5.1.5; derived anew.
Vector3d nearest_in_triangle(const Vector3d& p, const Vector3d (&x)[3]) {
  const Vector3d ab = x[1] - x[0], ac = x[2] - x[0], ap = p - x[0];
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return x[0];
  const Vector3d bp = p - x[1];
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return x[1];
  const double c = d1 * d4 - d3 * d2;
  if (c <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return x[0] + d1 / (d1 - d3) * ab;
  const Vector3d cp = p - x[2];
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return x[2];
  const double b = d5 * d2 - d1 * d6;
  if (b <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return x[0] + d2 / (d2 - d6) * ac;
  const double a = d3 * d6 - d5 * d4;
  if (a <= 0.0 && d4 >= d3 && d5 >= d6)
    return x[1] + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (x[2] - x[1]);
  const double sum = a + b + c;
  return x[0] + (b * ab + c * ac) / sum;
}

}  // namespace

SolidOracle::SolidOracle(const SurfaceMesh& surface, const std::vector<int>& group) {
  const auto n = static_cast<std::size_t>(surface.triangles.rows());
  std::vector<Vector3d> centers(n);
  for (std::size_t t = 0; t < n; ++t) {
    const auto row = static_cast<Eigen::Index>(t);
    centers[t] =
        (corner(surface, row, 0) + corner(surface, row, 1) + corner(surface, row, 2)) / 3.0;
  }
  order_.resize(n);
  std::iota(order_.begin(), order_.end(), 0);
  corners_.resize(n);
  for (std::size_t t = 0; t < n; ++t)
    for (int k = 0; k < 3; ++k) corners_[t].x[k] = corner(surface, static_cast<Eigen::Index>(t), k);
  const std::vector<Corners> by_triangle = corners_;
  nodes_.reserve(n);
  build(0, static_cast<int>(n), centers);
  group_.resize(n);
  place_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    place_[static_cast<std::size_t>(order_[i])] = static_cast<int>(i);
    corners_[i] = by_triangle[static_cast<std::size_t>(order_[i])];
    group_[i] = group[static_cast<std::size_t>(order_[i])];
  }
}

// Splits at the median of the longest side of the box of the centers.
void SolidOracle::build(int first, int last, const std::vector<Vector3d>& centers) {
  const std::size_t index = nodes_.size();
  Node node{Vector3d::Constant(kInfinity), Vector3d::Constant(-kInfinity), first, last - first};
  Vector3d lower = node.lower, upper = node.upper;
  for (int i = first; i < last; ++i) {
    const int t = order_[static_cast<std::size_t>(i)];
    for (const Vector3d& x : corners_[static_cast<std::size_t>(t)].x) {
      node.lower = node.lower.cwiseMin(x);
      node.upper = node.upper.cwiseMax(x);
    }
    lower = lower.cwiseMin(centers[static_cast<std::size_t>(t)]);
    upper = upper.cwiseMax(centers[static_cast<std::size_t>(t)]);
  }
  nodes_.push_back(node);
  if (last - first <= kLeafSize) return;
  int axis;
  (upper - lower).maxCoeff(&axis);
  const int middle = (first + last) / 2;
  std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                   [&](int s, int t) {
                     const double x = centers[static_cast<std::size_t>(s)][axis];
                     const double y = centers[static_cast<std::size_t>(t)][axis];
                     return x < y || (x == y && s < t);
                   });
  build(first, middle, centers);
  nodes_[index].first = static_cast<int>(nodes_.size());
  nodes_[index].count = 0;
  build(middle, last, centers);
}

// Visits the triangles of all leaves whose boxes `enter` accepts, until `visit` returns true.
template <class Enter, class Visit>
void SolidOracle::traverse(Enter enter, Visit visit) const {
  std::array<int, kMaxDepth> stack;
  int depth = 0;
  stack[0] = 0;
  while (depth >= 0) {
    const int at = stack[static_cast<std::size_t>(depth--)];
    const Node& node = nodes_[static_cast<std::size_t>(at)];
    if (!enter(node.lower, node.upper)) continue;
    if (node.count == 0) {
      stack[static_cast<std::size_t>(++depth)] = node.first;
      stack[static_cast<std::size_t>(++depth)] = at + 1;
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i)
      if (visit(static_cast<std::size_t>(i))) return;
  }
}

std::optional<SolidOracle::Hit> SolidOracle::hit(const Vector3d& a, const Vector3d& b) const {
  if (a == b) return {};
  const Ray ray(a, b);
  std::optional<Hit> found;
  traverse([&](const Vector3d& lower, const Vector3d& upper) { return ray.enters(lower, upper); },
           [&](std::size_t i) {
             Vector3d point;
             if (!ray.crosses(corners_[i].x, point)) return false;
             found = Hit{point, order_[i]};
             return true;
           });
  return found;
}

std::optional<SolidOracle::Hit> SolidOracle::first_hit(const Vector3d& a, const Vector3d& b,
                                                       int except) const {
  if (a == b) return {};
  const Ray ray(a, b);
  Nearest found{a};
  traverse([&](const Vector3d& lower, const Vector3d& upper) { return ray.enters(lower, upper); },
           [&](std::size_t i) {
             if (order_[i] != except) found.offer(ray, corners_[i].x, order_[i]);
             return false;
           });
  return found.hit();
}

std::optional<SolidOracle::Hit> SolidOracle::first_hit(const Vector3d& a, const Vector3d& b,
                                                       int except,
                                                       const std::vector<int>& candidates) const {
  if (a == b) return {};
  const Ray ray(a, b);
  Nearest found{a};
  for (const int t : candidates)
    if (t != except)
      found.offer(ray, corners_[static_cast<std::size_t>(place_[static_cast<std::size_t>(t)])].x,
                  t);
  return found.hit();
}

std::optional<SolidOracle::Piece> SolidOracle::clip(const Vector3d& base, const Vector3d& direction,
                                                    double first, double last) const {
  const Vector3d margin = Vector3d::Constant(0.01 * (upper() - lower()).norm());
  for (int k = 0; k < 3; ++k) {
    const double low = lower()[k] - margin[k] - base[k], high = upper()[k] + margin[k] - base[k];
    if (direction[k] == 0.0) {
      if (low > 0.0 || high < 0.0) return {};
      continue;
    }
    const double s = low / direction[k], t = high / direction[k];
    first = std::max(first, std::min(s, t));
    last = std::min(last, std::max(s, t));
  }
  if (!(first < last)) return {};
  return Piece{base + first * direction, base + last * direction};
}

// Whether the line from p upwards, in z, meets the triangle above p. In x and y the point is inside
// if the half-line towards +x leaves through one edge or three; an edge counts if its lower end is
// at or below p and its upper end above, so that neighbors never both claim or both drop it.
bool SolidOracle::meets(const Vector3d& p, const Corners& triangle) {
  const auto& x = triangle.x;
  bool inside = false;
  for (int k = 0; k < 3; ++k) {
    const Vector3d* low = &x[k];
    const Vector3d* high = &x[(k + 1) % 3];
    if (low->y() > high->y()) std::swap(low, high);
    if (!(low->y() <= p.y() && p.y() < high->y())) continue;
    const double side =
        (high->x() - low->x()) * (p.y() - low->y()) - (high->y() - low->y()) * (p.x() - low->x());
    inside ^= side > 0.0;
  }
  if (!inside) return false;
  const Vector3d normal = (x[1] - x[0]).cross(x[2] - x[0]);
  return normal.dot(p - x[0]) * normal.z() < 0.0;
}

bool SolidOracle::contains(const Vector3d& p) const {
  bool inside = false;
  traverse(
      [&](const Vector3d& lower, const Vector3d& upper) {
        return p.x() >= lower.x() && p.x() <= upper.x() && p.y() >= lower.y() &&
               p.y() <= upper.y() && p.z() <= upper.z();
      },
      [&](std::size_t i) {
        inside ^= meets(p, corners_[i]);
        return false;
      });
  return inside;
}

std::vector<int> SolidOracle::in_box(const Vector3d& lower, const Vector3d& upper) const {
  const auto meets_box = [&](const Vector3d& low, const Vector3d& high) {
    return (low.array() <= upper.array()).all() && (high.array() >= lower.array()).all();
  };
  std::vector<int> found;
  traverse(meets_box, [&](std::size_t i) {
    const auto& x = corners_[i].x;
    if (meets_box(x[0].cwiseMin(x[1]).cwiseMin(x[2]), x[0].cwiseMax(x[1]).cwiseMax(x[2])))
      found.push_back(order_[i]);
    return false;
  });
  return found;
}

SolidOracle::Hit SolidOracle::nearest(const Vector3d& p, int group) const {
  Hit best{p, -1};
  double distance = kInfinity;
  traverse([&](const Vector3d& lower,
               const Vector3d& upper) { return squared_distance(p, lower, upper) < distance; },
           [&](std::size_t i) {
             if (group >= 0 && group_[i] != group) return false;
             const Vector3d point = nearest_in_triangle(p, corners_[i].x);
             const double d = (point - p).squaredNorm();
             if (d < distance) {
               distance = d;
               best = {point, order_[i]};
             }
             return false;
           });
  return best;
}

std::optional<SolidOracle::Hit> SolidOracle::nearest_where(
    const Vector3d& p, double within, const std::function<bool(int)>& accepted) const {
  std::optional<Hit> best;
  double distance = within * within;
  traverse([&](const Vector3d& lower,
               const Vector3d& upper) { return squared_distance(p, lower, upper) < distance; },
           [&](std::size_t i) {
             const Vector3d point = nearest_in_triangle(p, corners_[i].x);
             const double d = (point - p).squaredNorm();
             if (!(d < distance) || !accepted(group_[i])) return false;
             distance = d;
             best = Hit{point, order_[i]};
             return false;
           });
  return best;
}

}  // namespace codesign::fem
