#include "fem/meshing/tet_improve.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "fem/mesh/tet_neighbors.hpp"

namespace codesign::fem {
namespace {

using Eigen::Vector3d;
using Tet = std::array<int, 4>;
using Side = std::array<int, 3>;

constexpr int kRounds = 6;
constexpr std::size_t kLargestRing = 7;        // tetrahedra around an edge that is removed
constexpr double kImproved = 1.001;            // a step must raise the quality by this factor
constexpr double kSteps[] = {0.3, 0.1, 0.03};  // of a point, relative to its shortest edge
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Smallest sine of the six dihedral angles, with the sign of the volume.
double quality(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  const Vector3d ab = b - a, ac = c - a, ad = d - a, bc = c - b, bd = d - b;
  const Vector3d nd = ab.cross(ac);  // twice the area of the side opposite to d, and so on
  const double volume = nd.dot(ad);  // six times
  const double sd = nd.norm(), sc = ab.cross(ad).norm(), sb = ac.cross(ad).norm(),
               sa = bc.cross(bd).norm();
  // The sine at an edge is 3/2 · volume · length / (area · area) of its two sides.
  const double at_edges[6] = {ab.norm() / (sc * sd), ac.norm() / (sb * sd),
                              ad.norm() / (sb * sc), bc.norm() / (sa * sd),
                              bd.norm() / (sa * sc), (d - c).norm() / (sa * sb)};
  return volume * *std::min_element(at_edges, at_edges + 6);
}

class Improver {
 public:
  Improver(LinearTets& mesh, double target, const SolidOracle& oracle, MeshWatch& watch)
      : mesh_(mesh),
        target_(target),
        oracle_(oracle),
        watch_(watch),
        alive_(mesh.tets.size(), true),
        tets_at_(mesh.points.size()),
        patch_(mesh.points.size(), -1) {
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
      for (const int p : mesh_.tets[t]) at(p).push_back(static_cast<int>(t));
      for (std::size_t k = 0; k < 4; ++k)
        if (mesh_.side_label[t][k] >= 0)
          for (const int c : kTetSides[k])
            patch_[index(mesh_.tets[t][index(c)])] = mesh_.side_label[t][k];
    }
  }

  int run() {
    for (int round = 0; round < kRounds; ++round) {
      bool changed = false;
      for (const int t : find_bad()) {
        watch_.step("improving elements");
        if (alive_[index(t)] && quality_of(t) < target_) changed |= improve(t);
      }
      if (!changed) break;
    }
    const auto left = static_cast<int>(find_bad().size());
    keep_only(mesh_, alive_);
    return left;
  }

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  std::vector<int>& at(int p) { return tets_at_[index(p)]; }
  const Vector3d& point(int p) const { return mesh_.points[index(p)]; }
  double quality_of(const Tet& t) const {
    return quality(point(t[0]), point(t[1]), point(t[2]), point(t[3]));
  }
  double quality_of(int t) const { return quality_of(mesh_.tets[index(t)]); }
  bool has_point(int t, int p) const {
    const Tet& tet = mesh_.tets[index(t)];
    return std::find(tet.begin(), tet.end(), p) != tet.end();
  }

  // Worst first.
  std::vector<int> find_bad() const {
    std::vector<std::pair<double, int>> found;
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
      if (!alive_[t]) continue;
      const double q = quality_of(static_cast<int>(t));
      if (q < target_) found.emplace_back(q, static_cast<int>(t));
    }
    std::sort(found.begin(), found.end());
    std::vector<int> bad;
    for (const auto& [q, t] : found) bad.push_back(t);
    return bad;
  }

  bool improve(int t) {
    const Tet tet = mesh_.tets[index(t)];
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j)
        if (remove_edge(tet[i], tet[j])) return true;
    for (std::size_t k = 0; k < 4; ++k)
      if (remove_side(t, k)) return true;
    bool moved = false;
    for (const int p : tet) moved |= move_point(p);
    return moved;
  }

  // Replaces tetrahedra by others that fill the same space, if the worst of them gets better.
  bool replace(const std::vector<int>& old, const std::vector<Tet>& fresh) {
    double before = kInfinity, after = kInfinity;
    for (const int t : old) before = std::min(before, quality_of(t));
    for (const Tet& tet : fresh) after = std::min(after, quality_of(tet));
    if (!(after > 0.0 && after > before * kImproved)) return false;
    std::vector<std::pair<Side, int>> labels;
    for (const int t : old) {
      for (std::size_t k = 0; k < 4; ++k)
        if (mesh_.side_label[index(t)][k] >= 0)
          labels.emplace_back(side_of(mesh_.tets[index(t)], k), mesh_.side_label[index(t)][k]);
      alive_[index(t)] = false;
      for (const int p : mesh_.tets[index(t)]) std::erase(at(p), t);
    }
    for (const Tet& tet : fresh) {
      std::array<int, 4> label{-1, -1, -1, -1};
      for (std::size_t k = 0; k < 4; ++k)
        for (const auto& [side, value] : labels)
          if (side == side_of(tet, k)) label[k] = value;
      for (const int p : tet) at(p).push_back(static_cast<int>(mesh_.tets.size()));
      mesh_.tets.push_back(tet);
      mesh_.side_label.push_back(label);
      alive_.push_back(true);
    }
    return true;
  }

  static Side side_of(const Tet& tet, std::size_t k) {
    Side side{tet[index(kTetSides[k][0])], tet[index(kTetSides[k][1])],
              tet[index(kTetSides[k][2])]};
    std::sort(side.begin(), side.end());
    return side;
  }

  // The tetrahedra around an inner edge and the ring of points around it, turning from a to b;
  // false on the boundary.
  bool find_ring(int a, int b, std::vector<int>& tets, std::vector<int>& ring) {
    std::vector<std::pair<int, int>> links;  // the other edge of each tetrahedron
    for (const int t : at(a)) {
      if (!has_point(t, b)) continue;
      std::array<int, 2> rest{};
      std::size_t n = 0;
      for (const int p : mesh_.tets[index(t)])
        if (p != a && p != b) rest[n++] = p;
      const Vector3d axis = point(b) - point(a);
      if (axis.cross(point(rest[0]) - point(a)).dot(point(rest[1]) - point(a)) < 0.0)
        std::swap(rest[0], rest[1]);
      links.emplace_back(rest[0], rest[1]);
      tets.push_back(t);
    }
    if (links.size() < 3 || links.size() > kLargestRing) return false;
    ring.push_back(links[0].first);
    for (std::size_t i = 0; i < links.size(); ++i) {
      const auto next = std::find_if(links.begin(), links.end(),
                                     [&](const auto& link) { return link.first == ring.back(); });
      if (next == links.end()) return false;
      if (i + 1 == links.size()) return next->second == ring.front();
      ring.push_back(next->second);
    }
    return false;
  }

  // Triangulates the ring so that the worst of the tetrahedra on both sides is best (dynamic
  // programming over its diagonals; G. T. Klincsek, 1980).
  bool remove_edge(int a, int b) {
    std::vector<int> old, ring;
    if (!find_ring(a, b, old, ring)) return false;
    const std::size_t n = ring.size();
    double best[kLargestRing][kLargestRing] = {};
    std::size_t apex[kLargestRing][kLargestRing] = {};
    for (std::size_t span = 1; span < n; ++span)
      for (std::size_t i = 0; i + span < n; ++i) {
        const std::size_t j = i + span;
        best[i][j] = span == 1 ? kInfinity : -kInfinity;
        for (std::size_t k = i + 1; k < j; ++k) {
          const double q =
              std::min({best[i][k], best[k][j], quality_of(Tet{ring[i], ring[k], ring[j], b}),
                        quality_of(Tet{ring[i], ring[j], ring[k], a})});
          if (q > best[i][j]) {
            best[i][j] = q;
            apex[i][j] = k;
          }
        }
      }
    if (!(best[0][n - 1] > 0.0)) return false;
    std::vector<Tet> fresh;
    std::vector<std::pair<std::size_t, std::size_t>> open{{0, n - 1}};
    while (!open.empty()) {
      const auto [i, j] = open.back();
      open.pop_back();
      if (j == i + 1) continue;
      const std::size_t k = apex[i][j];
      fresh.push_back({ring[i], ring[k], ring[j], b});
      fresh.push_back({ring[i], ring[j], ring[k], a});
      open.emplace_back(i, k);
      open.emplace_back(k, j);
    }
    return replace(old, fresh);
  }

  // Two tetrahedra with a common side become three around the edge between their far points.
  bool remove_side(int t, std::size_t k) {
    const Tet tet = mesh_.tets[index(t)];
    const int u = tet[index(kTetSides[k][0])], v = tet[index(kTetSides[k][1])],
              w = tet[index(kTetSides[k][2])];
    int other = -1;
    for (const int s : at(u))
      if (s != t && has_point(s, v) && has_point(s, w)) other = s;
    if (other < 0) return false;
    const int a = tet[k];
    int b = -1;
    for (const int p : mesh_.tets[index(other)])
      if (p != u && p != v && p != w) b = p;
    return replace({t, other}, {Tet{a, u, v, b}, Tet{a, v, w, b}, Tet{a, w, u, b}});
  }

  double worst_at(int p) {
    double worst = kInfinity;
    for (const int t : at(p)) worst = std::min(worst, quality_of(t));
    return worst;
  }

  bool move_point(int p) {
    if (mesh_.dimension[index(p)] < 2) return false;
    double shortest = kInfinity;
    for (const int t : at(p))
      for (const int q : mesh_.tets[index(t)])
        if (q != p) shortest = std::min(shortest, (point(q) - point(p)).norm());
    double best = worst_at(p);
    const double before = best;
    for (const double step : kSteps)
      for (int direction = 0; direction < 14; ++direction) {
        const Vector3d old = point(p);
        Vector3d target = old + step * shortest * direction_of(direction);
        if (mesh_.dimension[index(p)] == 2)
          target = oracle_.nearest(target, patch_[index(p)]).point;
        mesh_.points[index(p)] = target;
        const double now = worst_at(p);
        if (now > best)
          best = now;
        else
          mesh_.points[index(p)] = old;
      }
    return best > before * kImproved && best > 0.0;
  }

  // The 6 directions along the axes and the 8 between them.
  static Vector3d direction_of(int i) {
    if (i < 6) return (i % 2 ? -1.0 : 1.0) * Vector3d::Unit(i / 2);
    const int j = i - 6;
    return Vector3d(j & 1 ? 1 : -1, j & 2 ? 1 : -1, j & 4 ? 1 : -1) / std::sqrt(3.0);
  }

  LinearTets& mesh_;
  double target_;
  const SolidOracle& oracle_;
  MeshWatch& watch_;
  std::vector<bool> alive_;
  std::vector<std::vector<int>> tets_at_;
  std::vector<int> patch_;  // of points on the boundary: one of those around
};

}  // namespace

int improve_tets(LinearTets& mesh, double angle, const SolidOracle& oracle, MeshWatch& watch) {
  return Improver(mesh, std::sin(angle), oracle, watch).run();
}

}  // namespace codesign::fem
