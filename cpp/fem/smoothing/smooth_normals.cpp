#include "fem/smoothing/smooth_normals.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

namespace codesign::fem {
namespace {

using Eigen::Vector3d;

constexpr double kPrior = 0.2;      // weight of the first guess against that of an edge
constexpr double kVague = 0.02;     // its weight at a corner of a curved face, seen from one side
constexpr double kRuling = 3.0;     // weight of a straight line that runs into a fillet
constexpr double kCylinder = 2e-3;  // smallest over middle spread of a cylinder's normals
constexpr int kSolves = 3;          // the equations are linear in small turns only
constexpr int kCreaseRounds = 4;    // of finding creases below the feature angle
constexpr double kSameFlat = 3e-3;  // rad, between flats that are one
constexpr double kMisfit = 0.3;     // of the turn of a triangle's normals
constexpr double kMisfitAngle = 0.01;  // rad
constexpr double kNoTurn = 1e-3;       // rad: nothing to curve
constexpr double kOfFeature = 0.75;    // of the feature angle: a normal to the facet at its corner

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// Corners 3 t + k of triangles that share a normal, numbered by set.
struct Sectors {
  std::vector<int> of_corner;
  int count = 0;
};

int root(std::vector<int>& parent, int i) {
  while (parent[at(i)] != i) i = parent[at(i)] = parent[at(parent[at(i)])];
  return i;
}

Sectors find_sectors(const SurfaceMesh& surface, const Neighbors& neighbors,
                     const std::vector<std::array<bool, 3>>& sharp) {
  std::vector<int> parent(3 * neighbors.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto join = [&](int t, int k, int other) {
    for (int j = 0; j < 3; ++j)
      if (surface.triangles(other, j) == surface.triangles(t, k))
        parent[at(root(parent, 3 * t + k))] = root(parent, 3 * other + j);
  };
  for (int t = 0; t < std::ssize(neighbors); ++t)
    for (int k = 0; k < 3; ++k) {
      const int other = neighbors[at(t)][at(k)];
      if (other < 0 || sharp[at(t)][at(k)]) continue;
      join(t, k, other);
      join(t, (k + 1) % 3, other);
    }
  Sectors sectors;
  sectors.of_corner.assign(parent.size(), -1);
  std::vector<int> number(parent.size(), -1);
  for (int i = 0; i < std::ssize(parent); ++i) {
    int& mine = number[at(root(parent, i))];
    if (mine < 0) mine = sectors.count++;
    sectors.of_corner[at(i)] = mine;
  }
  return sectors;
}

// Normals of sectors and what is known about them.
struct SectorNormals {
  std::vector<Vector3d> normal;
  std::vector<bool> held, singular;
  std::vector<double> angle;  // of the triangles at the point, together, rad
};

// Angle [rad] of the triangles at a point of a straight border, or all around: the guess is that of
// both sides.
bool is_balanced(double angle) { return (angle > 2.6 && angle < 3.7) || angle > 5.0; }

SectorNormals first_guess(const SurfaceMesh& surface, const PlanarRegions& regions,
                          const Sectors& sectors, double cosine) {
  const auto n = at(sectors.count);
  SectorNormals guess{std::vector<Vector3d>(n, Vector3d::Zero()), std::vector<bool>(n, false),
                      std::vector<bool>(n, false), std::vector<double>(n, 0.0)};
  for (int i = 0; i < std::ssize(sectors.of_corner); ++i) {
    const int t = i / 3, k = i % 3, region = regions.of_triangle[at(t)];
    const std::size_t s = at(sectors.of_corner[at(i)]);
    const Vector3d p = corner(surface, t, k);
    const Vector3d a = corner(surface, t, (k + 1) % 3) - p;
    const Vector3d b = corner(surface, t, (k + 2) % 3) - p;
    const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
    guess.angle[s] += angle;
    if (regions.flat[at(region)]) {
      const Vector3d& normal = regions.normal[at(region)];
      if (guess.held[s] && guess.normal[s].cross(normal).norm() > kSameFlat)
        guess.singular[s] = true;
      if (!guess.held[s]) guess.normal[s] = normal;
      guess.held[s] = true;
    } else if (!guess.held[s]) {
      guess.normal[s] += angle * regions.normal[at(region)];
    }
  }
  for (Vector3d& normal : guess.normal) normal.normalize();
  for (int i = 0; i < std::ssize(sectors.of_corner); ++i) {
    const std::size_t s = at(sectors.of_corner[at(i)]);
    const int region = regions.of_triangle[at(i / 3)];
    if (guess.normal[s].dot(regions.normal[at(region)]) < cosine && !guess.held[s])
      guess.singular[s] = true;
  }
  return guess;
}

// Least squares (n + m) · c = 0 over the edges of all triangles, kPrior · change = 0.
class NormalFit {
 public:
  NormalFit(const SurfaceMesh& surface, const Neighbors& neighbors, const PlanarRegions& regions,
            const Sectors& sectors, const std::vector<Vector3d>& axis, SectorNormals& normals)
      : surface_(surface),
        neighbors_(neighbors),
        regions_(regions),
        sectors_(sectors),
        axis_(axis),
        normals_(normals),
        guess_(normals.normal),
        unknown_(normals.normal.size(), -1) {
    for (std::size_t s = 0; s < unknown_.size(); ++s)
      if (!normals.held[s] && !normals.singular[s]) unknown_[s] = 2 * free_++;
  }

  void run() {
    if (free_ == 0) return;
    for (int i = 0; i < kSolves; ++i) solve();
  }

 private:
  void solve() {
    terms_.clear();
    right_ = Eigen::VectorXd::Zero(2 * free_);
    axes_.resize(unknown_.size());
    for (std::size_t s = 0; s < unknown_.size(); ++s) {
      if (unknown_[s] < 0) continue;
      const Vector3d& n = normals_.normal[s];
      axes_[s] = {n.unitOrthogonal(), n.cross(n.unitOrthogonal())};
      const double weight = is_balanced(normals_.angle[s]) ? kPrior * kPrior : kVague * kVague;
      for (int j = 0; j < 2; ++j) {
        const Vector3d& axis = axes_[s][at(j)];
        terms_.emplace_back(unknown_[s] + j, unknown_[s] + j, weight);
        right_[unknown_[s] + j] += weight * axis.dot(guess_[s] - n);
      }
    }
    for (int t = 0; t < surface_.triangles.rows(); ++t)
      if (!regions_.flat[at(regions_.of_triangle[at(t)])])
        for (int k = 0; k < 3; ++k)
          if (!inside_plane(t, k)) add_edge(t, k);
    for (const auto& side : regions_.straight) {
      add_ruling(side.region, side.from, side.before);
      add_ruling(side.region, side.to, side.after);
    }
    for (int t = 0; t < surface_.triangles.rows(); ++t)
      for (int k = 0; k < 3 && axis_[at(t)] != Vector3d::Zero(); ++k)
        add_row({at(sectors_.of_corner[at(3 * t + k)])}, kRuling * axis_[at(t)]);
    Eigen::SparseMatrix<double> matrix(2 * free_, 2 * free_);
    matrix.setFromTriplets(terms_.begin(), terms_.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(matrix);
    const Eigen::VectorXd change = factor.solve(right_);
    for (std::size_t s = 0; s < unknown_.size(); ++s)
      if (unknown_[s] >= 0)
        normals_.normal[s] = (normals_.normal[s] + change[unknown_[s]] * axes_[s][0] +
                              change[unknown_[s] + 1] * axes_[s][1])
                                 .normalized();
  }

  // Diagonals of planar strips say nothing: another choice of them is the same surface.
  bool inside_plane(int t, int k) const {
    const int other = neighbors_[at(t)][at(k)];
    return other >= 0 && regions_.of_triangle[at(other)] == regions_.of_triangle[at(t)];
  }

  // At the tip of a cone only the other end says anything: its normal holds along the whole edge.
  void add_edge(int t, int k) {
    const int next = (k + 1) % 3;
    const std::array<std::size_t, 2> ends{at(sectors_.of_corner[at(3 * t + k)]),
                                          at(sectors_.of_corner[at(3 * t + next)])};
    const Vector3d along = (corner(surface_, t, next) - corner(surface_, t, k)).normalized();
    add_row({ends.begin(), ends.end()}, along);
  }

  // The normal at point p of a region is perpendicular to the side that leads to q.
  void add_ruling(int region, int p, int q) {
    if (p == q) return;
    const Vector3d along =
        (surface_.points.row(q) - surface_.points.row(p)).transpose().normalized();
    for (const int t : regions_.triangles[at(region)])
      for (int k = 0; k < 3; ++k)
        if (surface_.triangles(t, k) == p)
          return add_row({at(sectors_.of_corner[at(3 * t + k)])}, kRuling * along);
  }

  // Sum of the normals of sectors times a vector = 0.
  void add_row(const std::vector<std::size_t>& sectors, const Vector3d& along) {
    double misfit = 0.0;
    std::vector<std::pair<int, double>> row;
    for (const std::size_t s : sectors) {
      if (normals_.singular[s]) continue;
      misfit += normals_.normal[s].dot(along);
      for (int j = 0; j < 2 && unknown_[s] >= 0; ++j)
        row.emplace_back(unknown_[s] + j, axes_[s][at(j)].dot(along));
    }
    for (const auto& [i, a] : row) {
      right_[i] -= a * misfit;
      for (const auto& [j, b] : row) terms_.emplace_back(i, j, a * b);
    }
  }

  const SurfaceMesh& surface_;
  const Neighbors& neighbors_;
  const PlanarRegions& regions_;
  const Sectors& sectors_;
  const std::vector<Vector3d>& axis_;  // of the cylinder of each triangle, or zero
  SectorNormals& normals_;
  std::vector<Vector3d> guess_;
  std::vector<int> unknown_;  // first of the two of a sector, or -1
  int free_ = 0;
  std::vector<std::array<Vector3d, 2>> axes_;
  std::vector<Eigen::Triplet<double>> terms_;
  Eigen::VectorXd right_;
};

// Axis of the cylinder (of any cross-section) each triangle belongs to, as told by the normals of
// the regions connected with it; zero if none. Without it a rod's ends leave open whether its
// straight lines are bulged.
std::vector<Vector3d> cylinder_axes(const SurfaceMesh& surface, const Neighbors& neighbors,
                                    const SmoothNormals& found) {
  const PlanarRegions& regions = found.regions;
  std::set<std::pair<int, int>> straight;  // region, first point
  for (const auto& side : regions.straight) straight.insert({side.region, side.from});
  const auto n = static_cast<int>(regions.triangles.size());
  std::vector<int> parent(at(n));
  std::iota(parent.begin(), parent.end(), 0);
  for (int t = 0; t < std::ssize(neighbors); ++t)
    for (int k = 0; k < 3; ++k) {
      const int other = neighbors[at(t)][at(k)], r = regions.of_triangle[at(t)];
      if (other < 0 || found.sharp[at(t)][at(k)]) continue;
      const int s = regions.of_triangle[at(other)];
      if (regions.flat[at(r)] || regions.flat[at(s)] ||
          straight.count({r, surface.triangles(t, k)}) ||
          straight.count({s, surface.triangles(t, (k + 1) % 3)}))
        continue;
      parent[at(root(parent, r))] = root(parent, s);
    }
  std::vector<Eigen::Matrix3d> spread(at(n), Eigen::Matrix3d::Zero());
  std::vector<int> members(at(n), 0);
  std::vector<Vector3d> axis(neighbors.size(), Vector3d::Zero());
  for (int r = 0; r < n; ++r) {
    double area = 0.0;
    for (const int t : regions.triangles[at(r)]) area += triangle_area(surface, t);
    const Vector3d& normal = regions.normal[at(r)];
    spread[at(root(parent, r))] += area * normal * normal.transpose();
    ++members[at(root(parent, r))];
  }
  for (int r = 0; r < n; ++r) {
    const int group = root(parent, r);
    if (members[at(group)] < 3) continue;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(spread[at(group)]);
    if (eigen.eigenvalues()[0] > kCylinder * eigen.eigenvalues()[1]) continue;
    for (const int t : regions.triangles[at(r)]) axis[at(t)] = eigen.eigenvectors().col(0);
  }
  return axis;
}

// Whether the normals at the corners are those of a surface of which triangle t is a chord.
bool fits(const SurfaceMesh& surface, const SmoothNormals& found, int t, double cosine) {
  const Vector3d& facet = found.regions.normal[at(found.regions.of_triangle[at(t)])];
  const auto& normals = found.at_corner[at(t)];
  const auto& singular = found.singular[at(t)];
  double turn = 0.0;
  for (int k = 0; k < 3; ++k) {
    if (singular[at(k)]) continue;
    if (normals[at(k)].dot(facet) < cosine) return false;
    if (!singular[at((k + 1) % 3)])
      turn = std::max(turn, normals[at(k)].cross(normals[at((k + 1) % 3)]).norm());
  }
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    const Vector3d along = (corner(surface, t, next) - corner(surface, t, k)).normalized();
    double misfit = 0.0;
    for (const int j : {k, next})
      if (!singular[at(j)]) misfit += normals[at(j)].dot(along);
    if (std::abs(misfit) > kMisfit * turn + kMisfitAngle) return false;
  }
  return turn > kNoTurn;
}

void solve_normals(const SurfaceMesh& surface, const Neighbors& neighbors, double cosine,
                   SmoothNormals& found) {
  const Sectors sectors = find_sectors(surface, neighbors, found.sharp);
  SectorNormals normals = first_guess(surface, found.regions, sectors, cosine);
  const std::vector<Vector3d> axis = cylinder_axes(surface, neighbors, found);
  NormalFit(surface, neighbors, found.regions, sectors, axis, normals).run();
  for (int t = 0; t < surface.triangles.rows(); ++t) {
    const int region = found.regions.of_triangle[at(t)];
    const bool flat = found.regions.flat[at(region)];
    for (int k = 0; k < 3; ++k) {
      const std::size_t s = at(sectors.of_corner[at(3 * t + k)]);
      found.at_corner[at(t)][at(k)] = flat ? found.regions.normal[at(region)] : normals.normal[s];
      found.singular[at(t)][at(k)] = !flat && normals.singular[s];
    }
    found.curved[at(t)] = !flat && fits(surface, found, t, cosine);
  }
}

// Where a flat meets a facet that does not run into it tangentially, the edge is a crease.
bool mark_creases(const Neighbors& neighbors, SmoothNormals& found) {
  bool any = false;
  const auto flat = [&](int t) { return found.regions.flat[at(found.regions.of_triangle[at(t)])]; };
  for (int t = 0; t < std::ssize(neighbors); ++t)
    for (int k = 0; k < 3; ++k) {
      const int other = neighbors[at(t)][at(k)];
      if (other < 0 || found.sharp[at(t)][at(k)] || !flat(other)) continue;
      if (flat(t) || found.curved[at(t)]) continue;
      found.sharp[at(t)][at(k)] = true;
      for (std::size_t j = 0; j < 3; ++j)
        if (neighbors[at(other)][j] == t) found.sharp[at(other)][j] = true;
      any = true;
    }
  return any;
}

// Edges sharper than the feature angle, and those where neither side is curved.
void mark_sharp(const SurfaceMesh& surface, const Neighbors& neighbors, double feature_angle,
                SmoothNormals& found) {
  const PlanarRegions& regions = found.regions;
  std::set<std::pair<int, int>> straight;  // region, first point
  for (const auto& side : regions.straight) straight.insert({side.region, side.from});
  const auto runs_on = [&](int region, int from) {
    return regions.flat[at(region)] || straight.count({region, from}) > 0;
  };
  for (int t = 0; t < std::ssize(neighbors); ++t)
    for (int k = 0; k < 3; ++k) {
      const int other = neighbors[at(t)][at(k)];
      if (other < 0) continue;
      const int r = regions.of_triangle[at(t)], s = regions.of_triangle[at(other)];
      const double cosine = regions.normal[at(r)].dot(regions.normal[at(s)]);
      found.sharp[at(t)][at(k)] =
          r != s &&
          (cosine < std::cos(feature_angle) ||
           (runs_on(r, surface.triangles(t, k)) && runs_on(s, surface.triangles(t, (k + 1) % 3))));
    }
}

}  // namespace

SmoothNormals find_smooth_normals(const SurfaceMesh& surface, double feature_angle) {
  const Neighbors neighbors = triangle_neighbors(surface.triangles);
  const std::size_t n = neighbors.size();
  SmoothNormals found{std::vector<std::array<Vector3d, 3>>(n), std::vector<std::array<bool, 3>>(n),
                      std::vector<std::array<bool, 3>>(n), std::vector<bool>(n),
                      find_planar_regions(surface, neighbors)};
  mark_flat_regions(surface, neighbors, found.regions, feature_angle);
  mark_sharp(surface, neighbors, feature_angle, found);
  const double cosine = std::cos(kOfFeature * feature_angle);
  solve_normals(surface, neighbors, cosine, found);
  for (int i = 0; i < kCreaseRounds && mark_creases(neighbors, found); ++i)
    solve_normals(surface, neighbors, cosine, found);
  return found;
}

}  // namespace codesign::fem
