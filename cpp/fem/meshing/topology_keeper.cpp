#include "fem/meshing/topology_keeper.hpp"

#include <algorithm>
#include <cstdio>

#include "errors.hpp"
#include "fem/meshing/surface_match.hpp"
#include "fem/meshing/wall_size.hpp"

namespace codesign::fem {
namespace {

// Faults below both are smaller than what surfaces are simplified by.
constexpr double kResolved = 5e-5;  // m
constexpr double kOfExtent = 5e-4;

constexpr int kBreakdowns = 3;  // that are answered by another size
constexpr double kOtherSize = 0.9;

int total_genus(const Topology& topology) {
  int genus = 0;
  for (const int euler : topology.euler) genus += genus_of(euler);
  return genus;
}

// What is different, in words.
std::string difference(const Topology& found, const Topology& wanted) {
  if (found.euler.size() != wanted.euler.size())
    return std::to_string(found.euler.size()) + " closed boundaries instead of " +
           std::to_string(wanted.euler.size());
  if (!found.is_manifold())
    return std::to_string(found.open_edges + found.pinched_points) +
           " edges and points where the boundary is not manifold";
  return "genus " + std::to_string(total_genus(found)) + " instead of " +
         std::to_string(total_genus(wanted));
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
  if (large == 0 && found.euler.size() == prepared_.topology.euler.size()) {
    small_ = static_cast<int>(mismatches.size());
    return true;
  }
  mismatch_ = "the mesh has another topology than its surface near " +
              place_text(mismatches.front().place) + ": " + difference(found, prepared_.topology);
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
