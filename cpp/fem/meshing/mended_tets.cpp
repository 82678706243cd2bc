#include "fem/meshing/mended_tets.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <unordered_map>
#include <utility>

#include "fem/mesh/tet_corners.hpp"
#include "fem/surface/connected_groups.hpp"
#include "fem/surface/edge_key.hpp"

namespace codesign::fem {
namespace {

using Eigen::Vector3d;

constexpr int kPasses = 20;      // over all points and edges where the solid touches itself
constexpr double kCrumb = 0.01;  // loose pieces are smaller than this part of the solid

class Mender {
 public:
  Mender(const HullTets& hull, const PreparedSurface& prepared)
      : hull_(hull),
        prepared_(prepared),
        tets_(Eigen::Map<const Tets4>(hull.tets.data()->data(), std::ssize(hull.tets), 4)),
        neighbors_(tet_neighbors(tets_)),
        inside_(hull.inside) {
    for (std::size_t t = 0; t < count(); ++t) {
      const Vector3d &a = point(t, 0), b = point(t, 1) - a, c = point(t, 2) - a;
      volume_.push_back(b.dot(c.cross(point(t, 3) - a)) / 6.0);
    }
  }

  // The center decides wherever a tetrahedron is at the boundary, or all of its corners on the
  // surface.
  void ask_centers(double share) {
    std::vector<std::size_t> other;
    for (std::size_t t = 0; t < count(); ++t) {
      const Vector3d middle = center(t);
      if (!is_near(t) || prepared_.oracle.contains(middle) == inside_[t]) continue;
      const double off = (prepared_.oracle.nearest(middle, -1).point - middle).norm();
      if (off > share * longest_edge(t)) other.push_back(t);
    }
    for (const std::size_t t : other) inside_[t] = !inside_[t];
  }

  // Fills what is closed in and lies in the solid or is no cavity of the surface, the smallest
  // first, and drops all pieces but the largest.
  void fill_and_drop() {
    const auto [group, groups] = connected_groups(
        neighbors_, [&](std::size_t t, std::size_t k) { return same(t, neighbors_[t][k]); });
    std::vector<Piece> pieces(static_cast<std::size_t>(groups));
    const auto piece = [&](std::size_t t) -> Piece& {
      return pieces[static_cast<std::size_t>(group[t])];
    };
    double whole = 0.0;
    for (std::size_t t = 0; t < count(); ++t) {
      piece(t).volume += volume_[t];
      for (const int next : neighbors_[t]) piece(t).open |= next < 0;
      if (inside_[t]) whole += volume_[t];
    }
    for (std::size_t t = 0; t < count(); ++t)
      if (!inside_[t] && !piece(t).open && !prepared_.oracle.contains(center(t)))
        piece(t).empty += volume_[t];
    const double least = least_cavity(pieces);
    for (std::size_t t = 0; t < count(); ++t)
      inside_[t] =
          inside_[t] ? piece(t).volume > kCrumb * whole : !piece(t).open && piece(t).empty < least;
  }

  // Turns the parts of least volume about edges and points at which the boundary is not manifold,
  // but for those that can be told apart by having their points twice.
  void part_touching() {
    for (int pass = 0; pass < kPasses; ++pass) {
      CornerGroups groups = group_corners(tets_, neighbors_, inside_);
      turned_.assign(count(), false);
      const bool edges = turn_at_edges(groups), points = turn_at_points(groups);
      if (!edges && !points) return;
    }
  }

  LinearTets take() {
    CornerGroups groups = group_corners(tets_, neighbors_, inside_);
    LinearTets mesh;
    std::unordered_map<std::size_t, int> index;
    for (std::size_t t = 0; t < count(); ++t) {
      if (!inside_[t]) continue;
      std::array<int, 4> tet{}, labels{};
      for (std::size_t k = 0; k < 4; ++k) {
        const auto [at, fresh] =
            index.try_emplace(groups.points.find(4 * t + k), static_cast<int>(mesh.points.size()));
        if (fresh) {
          mesh.points.push_back(point(t, k));
          mesh.dimension.push_back(hull_.dimension[static_cast<std::size_t>(hull_.tets[t][k])]);
        }
        tet[k] = at->second;
        labels[k] = same(t, neighbors_[t][k]) ? -1 : patch_at(t, k);
      }
      mesh.tets.push_back(tet);
      mesh.side_label.push_back(labels);
    }
    return mesh;
  }

 private:
  struct Piece {  // tetrahedra inside, or outside, that hang together
    double volume = 0.0;
    double empty = 0.0;  // of a void, what is outside of the surface
    bool open = false;   // to the hull
  };

  struct Part {  // tetrahedra about an edge or a point that hang together
    std::vector<std::size_t> tets;
    double volume = 0.0;
    bool inside = false;
  };
  using Parts = std::map<std::size_t, Part>;  // by the item that stands for them

  std::size_t count() const { return hull_.tets.size(); }
  const Vector3d& point(std::size_t t, std::size_t k) const {
    return hull_.points[static_cast<std::size_t>(hull_.tets[t][k])];
  }
  Vector3d center(std::size_t t) const {
    return 0.25 * (point(t, 0) + point(t, 1) + point(t, 2) + point(t, 3));
  }
  bool same(std::size_t t, int other) const {
    return other >= 0 && inside_[static_cast<std::size_t>(other)] == inside_[t];
  }

  // The surface's cavities are the pieces that are closed in and empty by most.
  double least_cavity(const std::vector<Piece>& pieces) const {
    std::vector<double> empty;
    for (const Piece& piece : pieces)
      if (!piece.open && piece.empty > 0.5 * piece.volume) empty.push_back(piece.empty);
    const std::size_t cavities = prepared_.topology.euler.size() - 1;
    if (cavities == 0 || empty.empty()) return std::numeric_limits<double>::infinity();
    std::sort(empty.rbegin(), empty.rend());
    return empty[std::min(cavities, empty.size()) - 1];
  }

  bool is_near(std::size_t t) const {
    bool surface = true;
    for (const int i : hull_.tets[t]) surface &= hull_.dimension[static_cast<std::size_t>(i)] < 3;
    return surface || std::any_of(neighbors_[t].begin(), neighbors_[t].end(),
                                  [&](int next) { return !same(t, next); });
  }

  double longest_edge(std::size_t t) const {
    double longest = 0.0;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < i; ++j)
        longest = std::max(longest, (point(t, i) - point(t, j)).norm());
    return longest;
  }

  int patch_at(std::size_t t, std::size_t k) const {
    Vector3d middle = Vector3d::Zero();
    for (const int i : kTetSides[k]) middle += point(t, static_cast<std::size_t>(i)) / 3.0;
    const auto triangle = prepared_.oracle.nearest(middle, -1).triangle;
    return prepared_.patches.of_triangle[static_cast<std::size_t>(triangle)];
  }

  void add(Parts& parts, std::size_t root, std::size_t t) const {
    Part& part = parts[root];
    part.tets.push_back(t);
    part.volume += volume_[t];
    part.inside = inside_[t];
  }

  // Turns the smallest of the parts for which `counts` holds, unless something at it was turned.
  template <class Counts>
  bool turn_smallest(const Parts& parts, Counts counts) {
    const Part* smallest = nullptr;
    for (const auto& [root, part] : parts) {
      for (const std::size_t t : part.tets)
        if (turned_[t]) return true;  // looked at in the next pass
      if (counts(part) && (smallest == nullptr || part.volume < smallest->volume)) smallest = &part;
    }
    if (smallest == nullptr) return false;
    for (const std::size_t t : smallest->tets) {
      inside_[t] = !inside_[t];
      turned_[t] = true;
    }
    return true;
  }

  // The items (6 · t + edge) of all edges at which more than two sides of the boundary meet.
  std::map<std::uint64_t, std::vector<std::size_t>> crowded_edges() const {
    const auto key_of = [&](std::size_t t, std::size_t e) {
      const auto [a, b] = edge_corners(e);
      return edge_key(hull_.tets[t][a], hull_.tets[t][b]);
    };
    std::unordered_map<std::uint64_t, int> sides;
    for (std::size_t t = 0; t < count(); ++t)
      for (std::size_t k = 0; k < 4; ++k) {
        if (!inside_[t] || same(t, neighbors_[t][k])) continue;
        for (std::size_t e = 0; e < 6; ++e)
          if (const auto [a, b] = edge_corners(e); a != k && b != k) ++sides[key_of(t, e)];
      }
    std::map<std::uint64_t, std::vector<std::size_t>> items;
    for (const auto& [key, number] : sides)
      if (number > 2) items[key];
    if (items.empty()) return items;
    for (std::size_t t = 0; t < count(); ++t)
      for (std::size_t e = 0; e < 6; ++e)
        if (const auto at = items.find(key_of(t, e)); at != items.end())
          at->second.push_back(6 * t + e);
    return items;
  }

  // Edges with two parts inside that hang together at both ends.
  bool turn_at_edges(CornerGroups& groups) {
    bool turned = false;
    for (const auto& [key, items] : crowded_edges()) {
      std::map<std::size_t, std::array<std::size_t, 2>> ends;  // of the parts inside
      Parts parts;
      for (const std::size_t item : items) {
        const std::size_t t = item / 6;
        add(parts, groups.edges.find(item), t);
        if (!inside_[t]) continue;
        auto [a, b] = edge_corners(item % 6);
        if (hull_.tets[t][a] > hull_.tets[t][b]) std::swap(a, b);
        ends[groups.edges.find(item)] = {groups.points.find(4 * t + a),
                                         groups.points.find(4 * t + b)};
      }
      if (are_apart(ends)) continue;
      turned |= turn_smallest(parts, [](const Part&) { return true; });
    }
    return turned;
  }

  static bool are_apart(const std::map<std::size_t, std::array<std::size_t, 2>>& ends) {
    for (auto i = ends.begin(); i != ends.end(); ++i)
      for (auto j = std::next(i); j != ends.end(); ++j)
        if (i->second == j->second) return false;  // at both ends
    return true;
  }

  // Points whose part inside has several rims: the parts outside that it encloses are filled.
  bool turn_at_points(CornerGroups& groups) {
    struct Rim {
      int tets = 0, sides = 0, edges = 0;
    };
    std::unordered_map<std::size_t, Rim> rims;  // by the part of the point that is inside
    std::unordered_map<std::size_t, bool> seen;
    for (std::size_t t = 0; t < count(); ++t) {
      if (!inside_[t]) continue;
      for (std::size_t k = 0; k < 4; ++k) {
        Rim& rim = rims[groups.points.find(4 * t + k)];
        ++rim.tets;
        for (std::size_t side = 0; side < 4; ++side)
          rim.sides += side != k && !same(t, neighbors_[t][side]);
      }
      for (std::size_t e = 0; e < 6; ++e) {
        if (!seen.try_emplace(groups.edges.find(6 * t + e), true).second) continue;
        for (const std::size_t k : edge_corners(e)) ++rims[groups.points.find(4 * t + k)].edges;
      }
    }
    std::vector<std::vector<std::size_t>> items(hull_.points.size());  // 4 · t + corner
    std::vector<bool> faulty(hull_.points.size(), false);
    for (std::size_t t = 0; t < count(); ++t)
      for (std::size_t k = 0; k < 4; ++k) {
        const auto p = static_cast<std::size_t>(hull_.tets[t][k]);
        items[p].push_back(4 * t + k);
        if (!inside_[t] || turned_[t]) continue;
        const Rim& rim = rims[groups.points.find(4 * t + k)];
        const int euler = rim.edges - (3 * rim.tets + rim.sides) / 2 + rim.tets;
        faulty[p] = faulty[p] || (rim.sides > 0 && euler != 1);
      }
    bool turned = false;
    for (std::size_t p = 0; p < items.size(); ++p) {
      if (!faulty[p]) continue;
      Parts parts;
      for (const std::size_t item : items[p]) add(parts, groups.points.find(item), item / 4);
      turned |= turn_smallest(parts, [](const Part& part) { return !part.inside; });
    }
    return turned;
  }

  const HullTets& hull_;
  const PreparedSurface& prepared_;
  Tets4 tets_;
  TetNeighbors neighbors_;
  std::vector<bool> inside_, turned_;
  std::vector<double> volume_;
};

}  // namespace

LinearTets mend_tets(const HullTets& hull, const PreparedSurface& prepared, double share) {
  Mender mender(hull, prepared);
  mender.ask_centers(share);
  mender.fill_and_drop();
  mender.part_touching();
  mender.fill_and_drop();
  return mender.take();
}

}  // namespace codesign::fem
