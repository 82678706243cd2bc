#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "fem/meshing/size_points.hpp"
#include "fem/surface/surface_mesh.hpp"

namespace codesign::fem {

// A polyline (or a single point) near which elements are small.
struct SizeSource {
  Points points;  // (k, 3) m, k >= 1
  double size;    // edge length within `radius` of the polyline, m
  double growth;  // increase of the edge length per meter of distance beyond `radius`
  double radius;  // m
};

// Edge length s(x) = min(base, size + growth · max(0, distance - radius)) over all sources, and the
// edge lengths that thin walls ask for.
struct SizeField {
  double base;  // m
  std::vector<SizeSource> sources;
  std::vector<std::shared_ptr<const SizePoints>> walls = {};
};

// Throws std::invalid_argument: base or a size not positive, growth or radius negative, no points.
void check_size_field(const SizeField& field);

// Edge length wanted at `p`. [m]
double size_at(const SizeField& field, const Eigen::Vector3d& p);

// The smallest edge length anywhere. [m]
double smallest_size(const SizeField& field);

// The field with all edge lengths times a positive factor.
SizeField scaled(const SizeField& field, double factor);

}  // namespace codesign::fem
