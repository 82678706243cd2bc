#include "fem/meshing/prepared_surface.hpp"

#include <algorithm>
#include <utility>

#include "fem/surface/bodies.hpp"
#include "fem/surface/self_intersection.hpp"
#include "fem/surface/surface_check.hpp"

namespace codesign::fem {
namespace {

// Surfaces are never simplified by more than these parts of their extent and of the smallest size.
constexpr double kOfExtent = 5e-4;
constexpr double kOfSize = 0.1;

}  // namespace

PreparedSurface prepare_surface(const SurfaceMesh& input, const SizeField& size,
                                const MeshOptions& options) {
  check_surface(input);
  SurfaceMesh surface = input;
  const double tolerance =
      std::min({options.simplify, kOfExtent * extent(input.points), kOfSize * smallest_size(size)});
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
      topology = std::move(before);
    }
  Patches patches = find_patches(surface, options.feature_angle);
  check_one_body(surface, patches);
  std::vector<FeatureLine> lines = find_feature_lines(surface, patches);
  SolidOracle oracle(surface, patches.of_triangle);
  return {std::move(surface), simplified,       std::move(topology),
          std::move(patches), std::move(lines), std::move(oracle)};
}

}  // namespace codesign::fem
