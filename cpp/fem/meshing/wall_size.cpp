#include "fem/meshing/wall_size.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "fem/meshing/mesh_watch.hpp"
#include "fem/meshing/prepared_surface.hpp"
#include "fem/surface/surface_check.hpp"

namespace codesign::fem {
namespace {

using Eigen::Vector3d;

constexpr double kMeanWalls = 2.5;        // elements across the mean wall
constexpr double kMeanElements = 30'000;  // of the mean edge length, about
constexpr double kGrowth = 0.4;           // of the edge length, per meter
constexpr double kSmallest = 1.0 / 20.0;  // edge length, relative to the base
constexpr double kRaise = 1.25;           // of the smallest edge length while there are too many
constexpr double kDensity = 4.6;          // elements per cube of the edge length (measured)
constexpr double kAround = 3.0;           // a refined place reaches this many edge lengths
constexpr double kFiner = 0.5;            // edge length at a fault
constexpr double kShrink = 0.8;           // of the edge length from round to round

double wall_length(const WallSample& wall, double smallest) {
  return std::max(kOfWall * wall.thickness, smallest);
}

void add_walls(SizeField& size, const std::vector<WallSample>& walls, double smallest) {
  std::vector<Vector3d> points;
  std::vector<double> sizes;
  for (const WallSample& wall : walls) {
    const double length = wall_length(wall, smallest);
    if (length >= size.base) continue;
    points.push_back(wall.point);
    sizes.push_back(length);
  }
  if (points.empty()) return;
  size.walls.push_back(
      std::make_shared<const SizePoints>(std::move(points), std::move(sizes), kGrowth));
}

// About how many elements the walls and what is between them lead to, without the grading.
double count_elements(const std::vector<WallSample>& walls, double smallest, double base,
                      double volume) {
  double elements = 0.0;
  for (const WallSample& wall : walls) {
    const double part = 0.5 * wall.area * wall.thickness;  // the other side has the other half
    volume -= part;
    elements += kDensity * part / std::pow(std::min(base, wall_length(wall, smallest)), 3);
  }
  return elements + kDensity * std::max(0.0, volume) / std::pow(base, 3);
}

}  // namespace

double mean_wall_size(const SurfaceMesh& surface) {
  const SurfaceReport report = check_surface(surface);
  return std::max(2.0 * report.volume / report.area / kMeanWalls,
                  std::cbrt(8.0 * report.volume / kMeanElements));
}

SizeField wall_size(const SurfaceMesh& input, double base, const MeshOptions& options) {
  SizeField size{base, {}};
  check_size_field(size);
  const SurfaceReport report = check_surface(input);
  MeshWatch(options).require_affordable(input, size);
  MeshOptions quick = options;
  quick.check_intersections = false;  // the mesher looks for them
  const std::vector<WallSample> walls =
      find_walls(prepare_surface(input, size, quick), base / kOfWall);
  double smallest = kSmallest * base;
  while (smallest < base && count_elements(walls, smallest, base, report.volume) > kMostElements)
    smallest *= kRaise;
  add_walls(size, walls, smallest);
  return size;
}

SizeField refine_at(const SizeField& size, const std::vector<Mismatch>& mismatches,
                    const std::vector<WallSample>& walls, int round) {
  std::vector<Vector3d> places;
  for (const Mismatch& mismatch : mismatches) places.push_back(mismatch.place);
  const SizePoints near(places, std::vector<double>(places.size(), 0.0), 1.0);
  const double shrink = std::pow(kShrink, round - 1);
  std::vector<Vector3d> points;
  std::vector<double> sizes;
  for (const WallSample& wall : walls) {
    const double now = size_at(size, wall.point), length = kOfWall * shrink * wall.thickness;
    if (length >= now) continue;
    const double reach = kAround * now;
    if (near.size_at(wall.point, reach) >= reach) continue;  // the distance to the next place
    points.push_back(wall.point);
    sizes.push_back(length);
  }
  if (points.empty() || round > 1)
    for (const Mismatch& mismatch : mismatches) {
      const double now = size_at(size, mismatch.place);
      points.push_back(mismatch.place);
      sizes.push_back(kFiner * (round > 1 ? std::min(mismatch.length, now) : now));
    }
  SizeField refined = size;
  refined.walls.push_back(
      std::make_shared<const SizePoints>(std::move(points), std::move(sizes), kGrowth));
  return refined;
}

}  // namespace codesign::fem
