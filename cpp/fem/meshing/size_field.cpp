#include "fem/meshing/size_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace codesign::fem {
namespace {

double squared_distance(const Points& line, const Eigen::Vector3d& p) {
  double best = (line.row(0).transpose() - p).squaredNorm();
  for (Eigen::Index i = 0; i + 1 < line.rows(); ++i) {
    const Eigen::Vector3d a = line.row(i).transpose();
    const Eigen::Vector3d ab = line.row(i + 1).transpose() - a;
    const Eigen::Vector3d ap = p - a;
    const double length2 = ab.squaredNorm();
    const double s = length2 > 0.0 ? std::clamp(ap.dot(ab) / length2, 0.0, 1.0) : 0.0;
    best = std::min(best, (ap - s * ab).squaredNorm());
  }
  return best;
}

bool positive(double x) { return x > 0.0 && std::isfinite(x); }
bool not_negative(double x) { return x >= 0.0 && std::isfinite(x); }

}  // namespace

void check_size_field(const SizeField& field) {
  if (!positive(field.base)) throw std::invalid_argument("base: must be positive and finite");
  for (const SizeSource& source : field.sources) {
    if (source.points.rows() == 0 || !source.points.allFinite())
      throw std::invalid_argument("points: a size source needs at least one finite point");
    if (!positive(source.size)) throw std::invalid_argument("size: must be positive and finite");
    if (!not_negative(source.growth)) throw std::invalid_argument("growth: must not be negative");
    if (!not_negative(source.radius)) throw std::invalid_argument("radius: must not be negative");
  }
}

double size_at(const SizeField& field, const Eigen::Vector3d& p) {
  double size = field.base;
  for (const SizeSource& source : field.sources) {
    const double distance = std::sqrt(squared_distance(source.points, p));
    size = std::min(size, source.size + source.growth * std::max(0.0, distance - source.radius));
  }
  for (const auto& wall : field.walls) size = wall->size_at(p, size);
  return size;
}

double smallest_size(const SizeField& field) {
  double size = field.base;
  for (const SizeSource& source : field.sources) size = std::min(size, source.size);
  for (const auto& wall : field.walls) size = std::min(size, wall->smallest());
  return size;
}

SizeField scaled(const SizeField& field, double factor) {
  SizeField other = field;
  other.base *= factor;
  for (SizeSource& source : other.sources) {
    source.size *= factor;
    source.growth *= factor;
  }
  for (auto& wall : other.walls) wall = std::make_shared<const SizePoints>(wall->scaled(factor));
  check_size_field(other);
  return other;
}

}  // namespace codesign::fem
