#include "dynamics/convex_distance.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

namespace codesign::dynamics {
namespace {

using Eigen::Vector3d;

constexpr int kMaxIterations = 128;
constexpr double kRelativeTolerance = 1e-12;  // of squared distances
constexpr double kSameFacet = 1e-9;           // of the size of D: lower bumps belong to the facet
constexpr double kContact = 1e-10;            // [m]: nearer than this counts as overlapping

// Number of the point that is farthest in a direction, the first of several.
Eigen::Index farthest(const HullPoints& points, const Vector3d& direction) {
  Eigen::Index best = 0;
  double most = -std::numeric_limits<double>::infinity();
  const double x = direction.x(), y = direction.y(), z = direction.z();
  const double* point = points.data();
  for (Eigen::Index i = 0; i < points.cols(); ++i, point += points.outerStride()) {
    const double along = x * point[0] + y * point[1] + z * point[2];
    if (along > most) {
      most = along;
      best = i;
    }
  }
  return best;
}

// The Minkowski difference, known by its farthest point in a direction.
struct Difference {
  const HullPoints& first;
  const HullPoints& second;
  const Pose& first_T_second;

  Vector3d support(const Vector3d& direction) const {
    const Vector3d opposite = -(first_T_second.R.transpose() * direction);
    const Vector3d second_point = second.col(farthest(second, opposite));
    return first.col(farthest(first, direction)) - first_T_second.R * second_point -
           first_T_second.p;
  }

  // A point inside, which tells from where the origin is seen.
  Vector3d middle() const {
    const Vector3d second_middle = second.rowwise().mean();
    return first.rowwise().mean() - first_T_second.R * second_middle - first_T_second.p;
  }
};

struct Simplex {
  std::array<Vector3d, 4> vertices;
  int count = 0;
  Vector3d nearest = Vector3d::Zero();  // its point nearest to the origin
};

// Takes the face spanned by the newest vertex and k others if its nearest point lies inside it and
// beats `best`.
template <int k>
void try_face(const Vector3d& newest, const std::array<Vector3d, k>& others, Simplex& best) {
  Eigen::Matrix<double, 3, k> edges;
  for (int i = 0; i < k; ++i) edges.col(i) = others[i] - newest;
  const Eigen::Matrix<double, k, k> gram = edges.transpose() * edges;
  if (!(gram.determinant() > 1e-14 * gram.diagonal().prod())) return;  // degenerate face
  const Eigen::Matrix<double, k, 1> weights = gram.inverse() * -(edges.transpose() * newest);
  if (weights.minCoeff() < 0.0 || weights.sum() > 1.0) return;
  const Vector3d point = newest + edges * weights;
  if (point.squaredNorm() >= best.nearest.squaredNorm()) return;
  best.nearest = point;
  best.count = k + 1;
  for (int i = 0; i < k; ++i) best.vertices[i] = others[i];
  best.vertices[k] = newest;
}

// Adds a vertex and keeps only the face nearest to the origin; it holds the new vertex.
Simplex with_vertex(const Simplex& old, const Vector3d& newest) {
  Simplex best;
  best.vertices[0] = newest;
  best.count = 1;
  best.nearest = newest;
  const auto& v = old.vertices;
  for (int i = 0; i < old.count; ++i) try_face<1>(newest, {v[i]}, best);
  for (int i = 0; i < old.count; ++i) {
    for (int j = i + 1; j < old.count; ++j) try_face<2>(newest, {v[i], v[j]}, best);
  }
  if (old.count == 3) try_face<3>(newest, {v[0], v[1], v[2]}, best);
  return best;
}

// How far a plane square to a direction keeps the origin from the difference, which lies beyond it
// along the direction; not positive if it does not.
double separation(const Difference& difference, const Vector3d& direction) {
  return direction.dot(difference.support(-direction)) / direction.norm();
}

// Distance of the difference from the origin, at most kContact if it holds the origin; or as soon
// as a plane shows that it is more than `limit`, the distance of that plane. `direction`: of such a
// plane of another posture, tried first, and then that of this one; zero if there is none.
double distance_to_origin(const Difference& difference, double limit, Vector3d& direction) {
  if (direction.squaredNorm() > 0.0) {
    const double apart = separation(difference, direction);
    if (apart > limit) return apart;
  }
  Simplex simplex = with_vertex({}, difference.middle());
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const double squared = simplex.nearest.squaredNorm();
    direction = simplex.nearest;
    if (squared <= kContact * kContact) break;
    const Vector3d vertex = difference.support(-simplex.nearest);
    const double along = simplex.nearest.dot(vertex);
    if (squared - along <= kRelativeTolerance * squared) break;
    if (along > 0.0 && along * along > limit * limit * squared) return along / std::sqrt(squared);
    const Simplex next = with_vertex(simplex, vertex);
    if (next.nearest.squaredNorm() >= squared) break;  // round-off: nothing left to gain
    simplex = next;
    if (simplex.count == 4) return 0.0;  // the origin lies inside a tetrahedron
  }
  return simplex.nearest.norm();
}

using Edge = std::pair<int, int>;  // of vertex numbers, as its facet runs through it

struct Facet {
  std::array<int, 3> corners;  // counter-clockwise seen from outside
  Vector3d normal;
  double offset;  // of its plane along the normal; infinite for a facet without area
};

// A convex polytope that grows towards the difference.
struct Polytope {
  std::vector<Vector3d> vertices;
  std::vector<Facet> facets;

  void add_facet(int a, int b, int c) {
    const Vector3d cross = (vertices[b] - vertices[a]).cross(vertices[c] - vertices[a]);
    const double area = cross.norm();
    const double longest = std::max((vertices[b] - vertices[a]).squaredNorm(),
                                    (vertices[c] - vertices[a]).squaredNorm());
    if (area <= kSameFacet * longest) {
      facets.push_back({{a, b, c}, Vector3d::Zero(), std::numeric_limits<double>::infinity()});
      return;
    }
    const Vector3d normal = cross / area;
    facets.push_back({{a, b, c}, normal, normal.dot(vertices[a])});
  }

  // Replaces the facets that see the new vertex by a fan from it to the edge of what it sees,
  // found by walking from one such facet to its neighbors: round-off cannot tear the surface.
  // False, and nothing done, if that edge is not one closed loop.
  bool add_vertex(const Vector3d& vertex, std::size_t seen_facet, double tolerance) {
    std::vector<bool> seen(facets.size(), false);
    std::vector<std::size_t> pending = {seen_facet};
    std::vector<Edge> rim;
    seen[seen_facet] = true;
    while (!pending.empty()) {
      const Facet facet = facets[pending.back()];
      pending.pop_back();
      for (int i = 0; i < 3; ++i) {
        const Edge edge(facet.corners[i], facet.corners[(i + 1) % 3]);
        const std::size_t other = facet_with(Edge(edge.second, edge.first));
        if (seen[other]) continue;
        if (facets[other].normal.dot(vertex) - facets[other].offset > tolerance) {
          seen[other] = true;
          pending.push_back(other);
        }
      }
    }
    for (std::size_t k = 0; k < facets.size(); ++k) {
      for (int i = 0; seen[k] && i < 3; ++i) {
        const Edge edge(facets[k].corners[i], facets[k].corners[(i + 1) % 3]);
        if (!seen[facet_with(Edge(edge.second, edge.first))]) rim.push_back(edge);
      }
    }
    if (!is_loop(rim)) return false;
    std::size_t kept = 0;
    for (std::size_t k = 0; k < facets.size(); ++k) {
      if (!seen[k]) facets[kept++] = facets[k];
    }
    facets.resize(kept);
    vertices.push_back(vertex);
    const int newest = static_cast<int>(vertices.size()) - 1;
    for (const auto& [from, to] : rim) add_facet(from, to, newest);
    return true;
  }

  std::size_t facet_with(const Edge& edge) const {
    const auto found = std::find_if(facets.begin(), facets.end(), [&](const Facet& facet) {
      const auto& c = facet.corners;
      return edge == Edge(c[0], c[1]) || edge == Edge(c[1], c[2]) || edge == Edge(c[2], c[0]);
    });
    return static_cast<std::size_t>(found - facets.begin());  // closed surface: always found
  }

  static bool is_loop(const std::vector<Edge>& edges) {
    int at = edges.front().second;
    for (std::size_t step = 1; step < edges.size(); ++step) {
      const auto next = std::find_if(edges.begin() + 1, edges.end(),
                                     [&](const Edge& edge) { return edge.first == at; });
      if (next == edges.end()) return false;
      at = next->second;
    }
    return at == edges.front().first;
  }
};

// A tetrahedron of points of the difference, as large as a few directions give; empty if flat.
Polytope first_tetrahedron(const Difference& difference) {
  std::vector<Vector3d> points;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        if (x != 0 || y != 0 || z != 0) points.push_back(difference.support(Vector3d(x, y, z)));
      }
    }
  }
  const auto farthest = [&](const auto& measure) {
    return *std::max_element(points.begin(), points.end(),
                             [&](const auto& p, const auto& q) { return measure(p) < measure(q); });
  };
  const Vector3d a = points.front();
  const Vector3d b = farthest([&](const Vector3d& p) { return (p - a).norm(); });
  const Vector3d c = farthest([&](const Vector3d& p) { return (p - a).cross(b - a).norm(); });
  const Vector3d normal = (b - a).cross(c - a);
  const Vector3d d = farthest([&](const Vector3d& p) { return std::abs((p - a).dot(normal)); });
  const double volume = (d - a).dot(normal);
  const double size = (b - a).norm();
  Polytope polytope;
  if (std::abs(volume) <= kRelativeTolerance * size * size * size) return polytope;
  polytope.vertices = {a, b, c, d};
  if (volume > 0.0) std::swap(polytope.vertices[1], polytope.vertices[2]);  // d below a, b, c
  polytope.add_facet(0, 1, 2);
  polytope.add_facet(0, 2, 3);
  polytope.add_facet(2, 1, 3);
  polytope.add_facet(1, 0, 3);
  return polytope;
}

// Distance of the origin, inside the difference, from its surface; 0 if it is not inside. The
// nearest facet of the polytope bounds it from below, every supporting plane from above: as soon as
// one shows that it is less than `least`, that bound.
double depth_of_origin(const Difference& difference, double least) {
  Polytope polytope = first_tetrahedron(difference);
  if (polytope.facets.empty()) return 0.0;
  const double tolerance = kSameFacet * (polytope.vertices[0] - polytope.vertices[3]).norm();
  double depth = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < 4 * kMaxIterations; ++iteration) {
    const auto nearest =
        std::min_element(polytope.facets.begin(), polytope.facets.end(),
                         [](const Facet& f, const Facet& g) { return f.offset < g.offset; });
    const double lower = nearest->offset;
    const Vector3d vertex = difference.support(nearest->normal);
    const double upper = nearest->normal.dot(vertex);
    depth = std::min(depth, upper);
    if (depth - lower <= tolerance || depth < least) break;
    const auto number = static_cast<std::size_t>(nearest - polytope.facets.begin());
    if (!polytope.add_vertex(vertex, number, tolerance)) break;
  }
  return std::max(depth, 0.0);
}

constexpr double kRigid = 1e-12;  // [m] and rotation entries: less is no motion

Sphere sphere_around(const PiecewiseConvex::Points* pieces, std::size_t count) {
  Vector3d low = pieces[0].rowwise().minCoeff(), high = pieces[0].rowwise().maxCoeff();
  for (std::size_t k = 1; k < count; ++k) {
    low = low.cwiseMin(pieces[k].rowwise().minCoeff());
    high = high.cwiseMax(pieces[k].rowwise().maxCoeff());
  }
  const Vector3d center = 0.5 * (low + high);
  double squared = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    squared = std::max(squared, (pieces[k].colwise() - center).colwise().squaredNorm().maxCoeff());
  }
  return {center, std::sqrt(squared)};
}

double gap(const Sphere& first, const Sphere& second) {
  return (first.center - second.center).norm() - first.radius - second.radius;
}

Sphere moved(const Sphere& sphere, const Pose& pose) {
  return {pose.R * sphere.center + pose.p, sphere.radius};
}

// Number of postures that tell: one if nothing moves.
std::size_t telling(const std::vector<Pose>& poses) {
  for (const Pose& pose : poses) {
    const double turned = (pose.R - poses.front().R).cwiseAbs().maxCoeff();
    if (std::max(turned, (pose.p - poses.front().p).cwiseAbs().maxCoeff()) >= kRigid) {
      return poses.size();
    }
  }
  return std::min<std::size_t>(1, poses.size());
}

struct Candidate {
  double bound = 0.0;
  std::size_t first = 0, second = 0, posture = 0;

  auto place() const { return std::tie(first, second, posture); }
};

// Order of a heap with the lowest bound on top.
bool later(const Candidate& a, const Candidate& b) {
  return a.bound != b.bound ? a.bound > b.bound : a.place() > b.place();
}

// Pairs of pieces that may come nearer than the limit.
std::vector<Candidate> candidates(const PiecewiseConvex& first, const PiecewiseConvex& second,
                                  const std::vector<Pose>& first_T_second, double limit) {
  std::vector<Candidate> found;
  for (std::size_t posture = 0; posture < telling(first_T_second); ++posture) {
    const Pose& pose = first_T_second[posture];
    if (gap(first.sphere(), moved(second.sphere(), pose)) >= limit) continue;
    for (std::size_t j = 0; j < second.pieces().size(); ++j) {
      const Sphere other = moved(second.spheres()[j], pose);
      if (gap(first.sphere(), other) >= limit) continue;
      for (std::size_t i = 0; i < first.pieces().size(); ++i) {
        const double bound = gap(first.spheres()[i], other);
        if (bound < limit) found.push_back({bound, i, j, posture});
      }
    }
  }
  return found;
}

// As `signed_distance`; direction: see `distance_to_origin`.
double signed_distance_from(Vector3d& direction, const HullPoints& first, const HullPoints& second,
                            const Pose& first_T_second, double limit) {
  const Difference difference{first, second, first_T_second};
  const double distance = distance_to_origin(difference, std::max(limit, 0.0), direction);
  return distance > kContact ? distance : -depth_of_origin(difference, std::max(-limit, 0.0));
}

}  // namespace

double signed_distance(const HullPoints& first, const HullPoints& second,
                       const Pose& first_T_second, double limit) {
  Vector3d direction = Vector3d::Zero();
  return signed_distance_from(direction, first, second, first_T_second, limit);
}

PiecewiseConvex::PiecewiseConvex(std::vector<Points> pieces)
    : pieces_(std::move(pieces)), sphere_(sphere_around(pieces_.data(), pieces_.size())) {
  for (const Points& piece : pieces_) spheres_.push_back(sphere_around(&piece, 1));
}

Approach nearest_approach(const PiecewiseConvex& first, const PiecewiseConvex& second,
                          const std::vector<Pose>& first_T_second, double limit) {
  std::vector<Candidate> open = candidates(first, second, first_T_second, limit);
  std::make_heap(open.begin(), open.end(), later);
  Approach nearest{limit, 0};
  Candidate place;
  // What parted two pieces in one posture mostly parts them in others, by more than the nearest.
  std::vector<Vector3d> apart(first.pieces().size() * second.pieces().size(), Vector3d::Zero());
  while (!open.empty() && open.front().bound <= nearest.distance) {
    const Candidate next = open.front();
    std::pop_heap(open.begin(), open.end(), later);
    open.pop_back();
    const double distance = signed_distance_from(
        apart[next.first * second.pieces().size() + next.second], first.pieces()[next.first],
        second.pieces()[next.second], first_T_second[next.posture], nearest.distance);
    const bool earlier = nearest.distance < limit && next.place() < place.place();
    if (distance < nearest.distance || (distance == nearest.distance && earlier)) {
      nearest = {distance, next.posture};
      place = next;
    }
  }
  return nearest;
}

}  // namespace codesign::dynamics
