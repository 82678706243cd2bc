#include "fem/stress/peak_stress.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "fem/mesh/tet10.hpp"
#include "fem/stress/surface_distance.hpp"

namespace codesign::fem {

namespace {

constexpr int kLattice = 10;  // (kLattice + 1)(kLattice + 2) / 2 = 66 points

using FaceStress = Eigen::Matrix<double, 6, 6>;  // column: a node of the face

FaceStress face_stress(const TetMesh& mesh, const Stresses& nodal, int triangle) {
  FaceStress s;
  for (int k = 0; k < 6; ++k) s.col(k) = nodal.row(mesh.boundary(triangle, k)).transpose();
  return s;
}

// Von Mises stress is convex, so its largest value at the Bezier control points of a quadratic
// field bounds it over the face.
double upper_bound(const FaceStress& s) {
  double bound = 0.0;
  for (int k = 0; k < 3; ++k) {
    const Voigt control = 2.0 * s.col(3 + k) - 0.5 * (s.col(k) + s.col((k + 1) % 3));
    bound = std::max({bound, von_mises(Voigt(s.col(k))), von_mises(control)});
  }
  return bound;
}

struct Sample {
  Eigen::Vector2d reference;
  Eigen::Matrix<double, 6, 1> values;
};

std::vector<Sample> lattice() {
  std::vector<Sample> samples;
  for (int i = 0; i <= kLattice; ++i) {
    for (int j = 0; i + j <= kLattice; ++j) {
      const Eigen::Vector2d xi(static_cast<double>(i) / kLattice,
                               static_cast<double>(j) / kLattice);
      samples.push_back({xi, tri6_values(xi)});
    }
  }
  return samples;
}

}  // namespace

PeakStress peak_stress(const TetMesh& mesh, const Stresses& nodal, const PeakExclusion& exclusion) {
  static const std::vector<Sample> samples = lattice();
  const double distance = exclusion.distance;
  const SurfaceDistance clamp(mesh, exclusion.clamped);
  const SurfaceDistance border = SurfaceDistance::to_border(mesh, exclusion.loaded);
  std::vector<std::pair<double, int>> faces;
  for (int t = 0; t < mesh.boundary.rows(); ++t) {
    const bool clamped = std::binary_search(exclusion.clamped.begin(), exclusion.clamped.end(), t);
    if (clamped && distance > 0) continue;
    faces.emplace_back(upper_bound(face_stress(mesh, nodal, t)), t);
  }
  std::sort(faces.begin(), faces.end(), std::greater<>());

  PeakStress peak;
  for (const auto& [bound, t] : faces) {
    if (peak.triangle >= 0 && bound <= peak.value) break;
    const FaceStress stress = face_stress(mesh, nodal, t);
    const FaceNodes x = face_nodes(mesh, t);
    const Eigen::Vector3d center = x.leftCols<3>().rowwise().mean();
    const double radius = (x.colwise() - center).colwise().norm().maxCoeff();
    // A face that lies inside the excluded zone as a whole needs no look at its points.
    if (radius < distance &&
        (clamp.within(center, distance - radius) || border.within(center, distance - radius))) {
      continue;
    }
    const bool near = distance > 0 && (clamp.within(center, distance + radius) ||
                                       border.within(center, distance + radius));
    for (const Sample& sample : samples) {
      const double value = von_mises(Voigt(stress * sample.values));
      if (peak.triangle >= 0 && value <= peak.value) continue;
      const Eigen::Vector3d position = x * sample.values;
      if (near && (clamp.within(position, distance) || border.within(position, distance))) continue;
      peak = {value, position, t, sample.reference};
    }
  }
  if (peak.triangle < 0) {
    throw std::invalid_argument(
        "the whole surface lies within the exclusion distance of supports and load borders: no "
        "place is left to read the peak stress; choose a smaller exclusion_distance");
  }
  return peak;
}

double peak_stress_error(const TetMesh& mesh, const PointStresses& points,
                         const RecoveryError& recovery, const PeakStress& peak) {
  constexpr double kShare = 0.4, kFloor = 0.03, kSlope = 0.5, kCoarse = 23.0;
  if (!(peak.value > 0)) return 0.0;
  double largest = 0.0;
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    bool touches = false;
    for (int i = 0; i < 4; ++i) {
      for (int k = 0; k < 3; ++k) touches |= mesh.tets(e, i) == mesh.boundary(peak.triangle, k);
    }
    if (touches) largest = std::max(largest, recovery.element[e]);
  }
  const double spread = recovery_spread(mesh, points, peak.triangle, peak.reference);
  const double x = (spread + kShare * largest) / peak.value;
  return (std::hypot(kFloor, kSlope * x) + kCoarse * x * x * x) * peak.value;
}

}  // namespace codesign::fem
