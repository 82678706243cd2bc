#include "fem/smoothing/surface_smooth.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "errors.hpp"
#include "fem/smoothing/edge_arcs.hpp"
#include "fem/smoothing/patch_splitter.hpp"
#include "fem/smoothing/smooth_normals.hpp"
#include "fem/surface/self_intersection.hpp"
#include "fem/surface/surface_check.hpp"

namespace codesign::fem {
namespace {

constexpr int kRounds = 12;           // of leaving triangles as they are
constexpr int kMostCrossings = 1000;  // looked for in a round

// Coarse triangles to leave as they are because their pieces fold or cross others.
std::vector<int> faulty_triangles(const SplitSurface& split) {
  if (!split.folded.empty()) return split.folded;
  std::vector<int> faulty;
  for (const auto& [a, b] : crossing_triangles(split.surface, kMostCrossings))
    for (const int piece : {a, b}) faulty.push_back(split.parent[static_cast<std::size_t>(piece)]);
  return faulty;
}

// Marks triangles, all of a flat at once; says whether any is new.
bool leave(const std::vector<int>& triangles, const PlanarRegions& regions,
           std::vector<bool>& literal) {
  bool any = false;
  for (const int t : triangles) {
    const auto region = static_cast<std::size_t>(regions.of_triangle[static_cast<std::size_t>(t)]);
    std::vector<int> together{t};
    if (regions.flat[region]) together = regions.triangles[region];
    for (const int other : together) {
      any = any || !literal[static_cast<std::size_t>(other)];
      literal[static_cast<std::size_t>(other)] = true;
    }
  }
  return any;
}

SmoothSurface unchanged(const SurfaceMesh& surface, std::string reason) {
  SmoothSurface result{surface, {}};
  result.report.reason = std::move(reason);
  return result;
}

}  // namespace

SmoothSurface smooth_surface(const SurfaceMesh& surface, double feature_angle) {
  if (!(feature_angle > 0.0 && feature_angle < std::numbers::pi / 2))
    throw std::invalid_argument("feature_angle: between 0 and 90 degrees");
  check_surface(surface);
  const SmoothNormals normals = find_smooth_normals(surface, feature_angle);
  const std::size_t n = normals.curved.size();
  std::vector<bool> literal(n);
  for (std::size_t t = 0; t < n; ++t) {
    const auto region = static_cast<std::size_t>(normals.regions.of_triangle[t]);
    literal[t] = !normals.curved[t] && !normals.regions.flat[region];
  }
  const auto before = std::count(literal.begin(), literal.end(), true);
  try {
    for (int round = 0; round < kRounds; ++round) {
      const EdgeArcs arcs = find_edge_arcs(surface, normals, literal, feature_angle);
      SplitSurface split = split_patches(surface, normals, arcs);
      if (split.curved == 0)
        return unchanged(surface, "nothing to curve: flat faces, or facets that are fine already");
      const std::vector<int> faulty = faulty_triangles(split);
      if (!faulty.empty()) {
        if (!leave(faulty, normals.regions, literal)) break;  // the facets themselves cross
        continue;
      }
      check_surface(split.surface);
      const double volume = enclosed_volume(surface);
      const auto left = std::count(literal.begin(), literal.end(), true) - before;
      SmoothReport report{split.curved, split.max_distance,
                          enclosed_volume(split.surface) / volume - 1.0, static_cast<int>(left),
                          ""};
      return {std::move(split.surface), std::move(report)};
    }
  } catch (const MeshError& error) {
    return unchanged(surface, std::string("curved, ") + error.what());
  }
  return unchanged(surface, "curved facets would cross each other");
}

}  // namespace codesign::fem
