#include "fem/meshing/topology_keeper.hpp"

#include <algorithm>
#include <cstdio>
#include <numeric>

#include "errors.hpp"
#include "fem/mesh/solid_euler.hpp"
#include "fem/meshing/surface_match.hpp"
#include "fem/meshing/wall_size.hpp"

namespace codesign::fem {
namespace {

// Faults below both are smaller than what surfaces are simplified by.
constexpr double kResolved = 5e-5;  // m
constexpr double kOfExtent = 5e-4;

constexpr int kBreakdowns = 3;  // that are answered by another size
constexpr double kOtherSize = 0.9;

int total_euler(const Topology& topology) {
  return std::accumulate(topology.euler.begin(), topology.euler.end(), 0);
}

// Of all pieces of a boundary with this sum of Euler characteristics.
int total_genus(int euler, const Topology& wanted) {
  return static_cast<int>(wanted.euler.size()) - euler / 2;
}

// What is different, in words. euler: that of the boundary by the solid.
std::string difference(const Topology& found, int euler, const Topology& wanted) {
  if (found.euler.size() != wanted.euler.size())
    return std::to_string(found.euler.size()) + " closed boundaries instead of " +
           std::to_string(wanted.euler.size());
  std::string text;
  if (euler != total_euler(wanted))
    text = "genus " + std::to_string(total_genus(euler, wanted)) + " instead of " +
           std::to_string(total_genus(total_euler(wanted), wanted));
  if (found.is_manifold()) return text;
  return text + (text.empty() ? "" : ", ") +
         std::to_string(found.open_edges + found.pinched_points) +
         " edges and points where the boundary is not manifold";
}

std::string place_text(const Eigen::Vector3d& p) {
  char text[96];
  std::snprintf(text, sizeof text, "(%.6g, %.6g, %.6g) mm", 1e3 * p.x(), 1e3 * p.y(), 1e3 * p.z());
  return text;
}

}  // namespace

TopologyKeeper::TopologyKeeper(const PreparedSurface& prepared, const SizeField& size,
                               const MeshOptions& options)
    : prepared_(prepared), size_(size), options_(options) {}

bool TopologyKeeper::accepts(const TetMesh& mesh) {
  const Topology found = measure_topology(boundary_triangles(mesh));
  if (found == prepared_.topology) return true;
  std::vector<Mismatch> mismatches = find_mismatches(mesh, prepared_.surface, prepared_.oracle);
  const double resolved = std::min(kResolved, kOfExtent * extent(prepared_.surface.points));
  const auto large = std::count_if(mismatches.begin(), mismatches.end(),
                                   [&](const Mismatch& m) { return m.size > resolved; });
  const int euler = 2 * solid_euler(mesh.tets.leftCols<4>());
  if (large == 0 && found.euler.size() == prepared_.topology.euler.size() &&
      euler == total_euler(prepared_.topology)) {
    small_ = static_cast<int>(mismatches.size());
    return true;
  }
  mismatch_ = "the mesh has another topology than its surface near " +
              place_text(mismatches.front().place) + ": " +
              difference(found, euler, prepared_.topology);
  if (round_ == options_.topology_rounds)
    throw MeshError(explain("it still has after " + std::to_string(round_) +
                            " rounds: a smaller edge length or a thicker wall is needed"));
  ++round_;
  if (large > 0) mismatches.resize(static_cast<std::size_t>(large));  // the first ones
  if (walls_.empty()) walls_ = find_walls(prepared_, size_.base / kOfWall);
  size_ = refine_at(size_, mismatches, walls_, round_);
  return false;
}

void TopologyKeeper::retry(const std::string& reason) {
  if (breakdowns_++ == kBreakdowns)
    throw MeshError(explain(reason + ", at four edge lengths: give another one"));
  size_ = scaled(size_, kOtherSize);
}

std::string TopologyKeeper::explain(const std::string& reason) const {
  return mismatch_.empty() ? reason : mismatch_ + "; refined there, " + reason;
}

void TopologyKeeper::report(TetMesh& mesh) const {
  mesh.report.refinements = round_;
  mesh.report.small_faults = small_;
  for (const int euler : prepared_.topology.euler) mesh.report.genus.push_back(genus_of(euler));
  if (options_.measure_distance)
    mesh.report.surface_distance =
        surface_distance(mesh, prepared_.surface, prepared_.oracle).distance;
}

}  // namespace codesign::fem
