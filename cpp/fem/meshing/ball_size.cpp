#include "fem/meshing/ball_size.hpp"

namespace codesign::fem {
namespace {

constexpr double kOfDistance = 0.7;  // to the nearest foreign patch

}  // namespace

double BallSize::at(const Eigen::Vector3d& p, int line, double size) const {
  const auto [first, second] = prepared_.lines[static_cast<std::size_t>(line)].patches;
  const auto foreign = [p = first, q = second](int patch) { return patch != p && patch != q; };
  const auto found = prepared_.oracle.nearest_where(p, size / kOfDistance, foreign);
  return found ? kOfDistance * (found->point - p).norm() : size;
}

}  // namespace codesign::fem
