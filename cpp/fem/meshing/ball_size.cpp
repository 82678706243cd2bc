#include "fem/meshing/ball_size.hpp"

namespace codesign::fem {
namespace {

constexpr double kOfDistance = 0.7;  // to the nearest foreign patch
constexpr double kOnLine = 1e-6;     // relative to the size

}  // namespace

double BallSize::at(const Eigen::Vector3d& p, int line, double size) const {
  const auto [first, second] = prepared_.lines[static_cast<std::size_t>(line)].patches;
  const auto foreign = [p = first, q = second](int patch) { return patch != p && patch != q; };
  const auto found = prepared_.oracle.nearest_where(p, size / kOfDistance, foreign);
  if (!found || on_feature_line(prepared_, *found, kOnLine * size)) return size;
  return kOfDistance * (found->point - p).norm();
}

}  // namespace codesign::fem
