#include "fem/meshing/prepared_surface.hpp"

#include <algorithm>
#include <utility>

#include "fem/surface/bodies.hpp"
#include "fem/surface/cap_flips.hpp"
#include "fem/surface/distance.hpp"
#include "fem/surface/self_intersection.hpp"
#include "fem/surface/surface_check.hpp"

namespace codesign::fem {
namespace {

// Surfaces are never simplified by more than these parts of their extent and of the smallest size.
constexpr double kOfExtent = 5e-4;
constexpr double kOfSize = 0.1;

// The surface without caps that fold it, unless it crosses itself then; the height of the highest.
std::pair<SurfaceMesh, double> without_caps(const SurfaceMesh& input, double tolerance,
                                            const MeshOptions& options) {
  SurfaceMesh surface = input;
  const double height = flip_caps(surface, tolerance, options.feature_angle);
  if (height > 0.0 && options.check_intersections && !crossing_triangles(surface, 1).empty())
    return {input, 0.0};
  return {std::move(surface), height};
}

}  // namespace

PreparedSurface prepare_surface(const SurfaceMesh& input, const SizeField& size,
                                const MeshOptions& options) {
  check_surface(input);
  const double tolerance =
      std::min({options.simplify, kOfExtent * extent(input.points), kOfSize * smallest_size(size)});
  auto [surface, height] = without_caps(input, tolerance, options);
  SimplifyReport simplified =
      options.check_intersections
          ? simplify_without_crossing(surface, tolerance, options.feature_angle)
          : simplify_surface(surface, tolerance, options.feature_angle);
  Topology topology = measure_topology(surface.triangles);
  if (simplified.collapsed > 0)
    if (Topology before = measure_topology(input.triangles); before != topology) {
      if (options.check_intersections) check_self_intersection(input);
      surface = input;
      simplified = {};
      height = 0.0;
      topology = std::move(before);
    }
  simplified.distance = std::max(simplified.distance, height);
  Patches patches = find_patches(surface, options.feature_angle);
  check_one_body(surface, patches);
  std::vector<FeatureLine> lines = find_feature_lines(surface, patches);
  SolidOracle oracle(surface, patches.of_triangle);
  return {std::move(surface), simplified,       std::move(topology),
          std::move(patches), std::move(lines), std::move(oracle)};
}

bool on_feature_line(const PreparedSurface& prepared, const SolidOracle::Hit& hit,
                     double tolerance) {
  for (int k = 0; k < 3; ++k)
    if (prepared.patches
            .line[static_cast<std::size_t>(hit.triangle)][static_cast<std::size_t>(k)] &&
        squared_distance_to_segment(hit.point, corner(prepared.surface, hit.triangle, k),
                                    corner(prepared.surface, hit.triangle, (k + 1) % 3)) <
            tolerance * tolerance)
      return true;
  return false;
}

}  // namespace codesign::fem
