#include "dynamics/disturbance.hpp"

#include <algorithm>
#include <cmath>

namespace codesign::dynamics {

namespace {

// One stream per purpose, so that adding a body does not change the gusts.
constexpr std::uint64_t kGustStream = 0x6775737473ULL;
constexpr std::uint64_t kMassStream = 0x6d6173736573ULL;
constexpr std::uint64_t kThrustStream = 0x746872757374ULL;

constexpr double kNodesPerTime = 20.0;
constexpr double kShortestInterval = 1e-3;  // [s]

RandomStream stream(std::uint64_t seed, std::uint64_t purpose) {
  RandomStream mixed(seed);
  return RandomStream(mixed.next() ^ purpose);
}

}  // namespace

Gusts::Gusts(const FlightSettings& settings)
    : mean_(settings.disturbances.wind_force),
      interval_(std::max(settings.disturbances.gust_time / kNodesPerTime, kShortestInterval)),
      memory_(std::exp(-interval_ / settings.disturbances.gust_time)),
      drive_(std::sqrt(1.0 - memory_ * memory_)),
      calm_(settings.disturbances.gust_deviation.isZero(0.0)),
      random_(stream(settings.disturbances.seed, kGustStream)) {
  deviation_ = std::sqrt(3.0 / (2.0 + memory_)) * settings.disturbances.gust_deviation;
  last_ = draw();
  next_ = memory_ * last_ + drive_ * draw();
}

Eigen::Vector3d Gusts::draw() {
  Eigen::Vector3d x;
  for (double& value : x) value = random_.normal();
  return x;
}

Eigen::Vector3d Gusts::at(double time) {
  if (calm_) return mean_;
  const double nodes = time / interval_;
  for (; static_cast<double>(node_ + 1) <= nodes; ++node_) {
    last_ = next_;
    next_ = memory_ * last_ + drive_ * draw();
  }
  const double share = nodes - static_cast<double>(node_);
  return mean_ + deviation_.cwiseProduct(last_ + share * (next_ - last_));
}

Eigen::VectorXd body_mass_scales(const Disturbances& disturbances, int bodies) {
  Eigen::VectorXd scales = Eigen::VectorXd::Constant(bodies, disturbances.mass_scale);
  if (disturbances.mass_deviation == 0.0) return scales;
  RandomStream random = stream(disturbances.seed, kMassStream);
  for (double& scale : scales) scale *= 1.0 + disturbances.mass_deviation * random.normal();
  return scales;
}

Eigen::VectorXd thrust_scales(const Disturbances& disturbances, int jets) {
  Eigen::VectorXd scales = disturbances.thrust_scale.size() > 0
                               ? disturbances.thrust_scale
                               : Eigen::VectorXd(Eigen::VectorXd::Ones(jets));
  if (disturbances.thrust_deviation == 0.0) return scales;
  RandomStream random = stream(disturbances.seed, kThrustStream);
  for (double& scale : scales) scale *= 1.0 + disturbances.thrust_deviation * random.normal();
  return scales;
}

Model scale_masses(const Model& model, const Eigen::VectorXd& scales) {
  Model scaled = model;
  scaled.total_mass = 0.0;
  for (std::size_t i = 0; i < scaled.bodies.size(); ++i) {
    const double scale = scales[static_cast<Eigen::Index>(i)];
    scaled.bodies[i].inertia.mass *= scale;
    scaled.bodies[i].inertia.inertia *= scale;
    scaled.total_mass += scaled.bodies[i].inertia.mass;
  }
  return scaled;
}

}  // namespace codesign::dynamics
