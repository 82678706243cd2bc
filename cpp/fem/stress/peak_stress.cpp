#include "fem/stress/peak_stress.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fem/mesh/tet10.hpp"
#include "interrupt.hpp"
#include "model_error.hpp"

namespace codesign::fem {

namespace {

constexpr int kLattice = 10;  // (kLattice + 1)(kLattice + 2) / 2 = 66 points

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

// Boundary triangles by the upper bound of their stress, largest first.
std::vector<std::pair<double, int>> by_bound(const TetMesh& mesh, const Stresses& nodal) {
  std::vector<std::pair<double, int>> faces;
  for (int t = 0; t < mesh.boundary.rows(); ++t) {
    faces.emplace_back(upper_bound(face_stress(mesh, nodal, t)), t);
  }
  std::sort(faces.begin(), faces.end(), std::greater<>());
  return faces;
}

// The largest sample over the faces outside the zone (left_out = false) or inside it.
PeakStress largest_sample(const TetMesh& mesh, const Stresses& nodal, const ExclusionZone& zone,
                          bool left_out) {
  PeakStress peak;
  for (const auto& [bound, t] : by_bound(mesh, nodal)) {
    check_interrupt();
    if (peak.triangle >= 0 && bound <= peak.value) break;
    raise_on_face(mesh, face_stress(mesh, nodal, t), t, zone, left_out, peak);
  }
  return peak;
}

// The largest root mean square difference over the elements that share a corner with the peak's.
double largest_error_around(const TetMesh& mesh, const RecoveryError& recovery,
                            const PeakStress& peak) {
  std::vector<int> corners;
  for (int k = 0; k < (peak.triangle < 0 ? 4 : 3); ++k) {
    corners.push_back(peak.triangle < 0 ? mesh.tets(peak.element, k)
                                        : mesh.boundary(peak.triangle, k));
  }
  double largest = 0.0;
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    bool touches = false;
    for (int i = 0; i < 4; ++i) {
      for (const int corner : corners) touches |= mesh.tets(e, i) == corner;
    }
    if (touches) largest = std::max(largest, recovery.element[e]);
  }
  return largest;
}

}  // namespace

const std::vector<FaceSample>& face_samples() {
  static const std::vector<FaceSample> samples = [] {
    std::vector<FaceSample> lattice;
    for (int i = 0; i <= kLattice; ++i) {
      for (int j = 0; i + j <= kLattice; ++j) {
        const Eigen::Vector2d xi(static_cast<double>(i) / kLattice,
                                 static_cast<double>(j) / kLattice);
        lattice.push_back({xi, tri6_values(xi)});
      }
    }
    return lattice;
  }();
  return samples;
}

Side side_of_face(const TetMesh& mesh, int triangle, const ExclusionZone& zone) {
  if (zone.skips(triangle)) return Side::inside;
  const FaceNodes x = face_nodes(mesh, triangle);
  const Eigen::Vector3d center = x.leftCols<3>().rowwise().mean();
  const double radius = (x.colwise() - center).colwise().norm().maxCoeff();
  if (zone.contains_ball(center, radius)) return Side::inside;
  return zone.touches_ball(center, radius) ? Side::both : Side::outside;
}

void raise_on_face(const TetMesh& mesh, const FaceStress& stress, int triangle,
                   const ExclusionZone& zone, bool left_out, PeakStress& peak) {
  const Side side = side_of_face(mesh, triangle, zone);
  if (side == (left_out ? Side::outside : Side::inside)) return;
  const FaceNodes x = face_nodes(mesh, triangle);
  for (const FaceSample& sample : face_samples()) {
    const double value = von_mises(Voigt(stress * sample.values));
    if (peak.read() && value <= peak.value) continue;
    const Eigen::Vector3d position = x * sample.values;
    const bool inside = side == Side::inside || (side == Side::both && zone.contains(position));
    if (inside == left_out) peak = {value, position, triangle, -1, sample.reference};
  }
}

void raise_in_element(const TetMesh& mesh, const ElementStress& stress, int element,
                      const ExclusionZone& zone, PeakStress& peak) {
  for (const Eigen::Vector3d& point : tet_rule_4().points) {
    const TetValues values = tet10_values(point);
    const double value = von_mises(Voigt(stress * values));
    if (peak.read() && value <= peak.value) continue;
    const Eigen::Vector3d position = tet_nodes(mesh, element) * values;
    if (!zone.contains(position)) peak = {value, position, -1, element, Eigen::Vector2d::Zero()};
  }
}

void throw_no_place_left() {
  throw ModelError(
      "the whole surface lies within the exclusion distance of supports and load borders: no "
      "place is left to read the peak stress; choose a smaller exclusion_distance or hold less "
      "of the surface");
}

PeakStress peak_stress(const TetMesh& mesh, const Stresses& nodal, const ExclusionZone& zone) {
  const PeakStress peak = largest_sample(mesh, nodal, zone, false);
  if (peak.triangle < 0) throw_no_place_left();
  return peak;
}

PeakStress stress_left_out(const TetMesh& mesh, const Stresses& nodal, const ExclusionZone& zone) {
  return largest_sample(mesh, nodal, zone, true);
}

bool beside_exclusion(const TetMesh& mesh, const PeakStress& peak, const ExclusionZone& zone) {
  constexpr double kBeside = 0.2;  // of the longest edge; face samples lie a tenth of it apart
  if (!peak.read()) return false;
  const int corners = peak.triangle >= 0 ? 3 : 4;
  double longest = 0.0;
  for (int i = 0; i < corners; ++i) {
    for (int k = 0; k < i; ++k) {
      const auto node = [&](int corner) {
        return peak.triangle >= 0 ? mesh.boundary(peak.triangle, corner)
                                  : mesh.tets(peak.element, corner);
      };
      longest = std::max(longest, (mesh.nodes.row(node(i)) - mesh.nodes.row(node(k))).norm());
    }
  }
  return zone.touches_ball(peak.position, kBeside * longest);
}

VolumeStress volume_stress(const TetMesh& mesh, const Stresses& nodal, const PointStresses& points,
                           const ExclusionZone& zone, double volume) {
  Eigen::Matrix<double, kTetNodes, 4> values;
  for (int q = 0; q < 4; ++q) {
    values.col(q) = tet10_values(tet_rule_4().points[static_cast<std::size_t>(q)]);
  }
  std::vector<std::pair<double, int>> samples;
  samples.reserve(static_cast<std::size_t>(4 * mesh.tets.rows()));
  Eigen::Matrix<double, 6, kTetNodes> stress;
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    for (int i = 0; i < kTetNodes; ++i) stress.col(i) = nodal.row(mesh.tets(e, i)).transpose();
    for (int q = 0; q < 4; ++q) {
      samples.emplace_back(von_mises(Voigt(stress * values.col(q))), 4 * e + q);
    }
  }
  std::sort(samples.begin(), samples.end(), std::greater<>());
  VolumeStress result;
  double above = 0.0;
  for (const auto& [value, point] : samples) {
    const int e = point / 4;
    const Eigen::Vector3d position = tet_nodes(mesh, e) * values.col(point % 4);
    if (zone.contains(position)) continue;
    if (result.largest.element < 0) result.largest = {value, position, -1, e, {}};
    result.exceeded = value;
    above += points.volume[point];
    if (above >= volume) break;
  }
  return result;
}

double peak_stress_error(const TetMesh& mesh, const std::vector<BodyPlace>& places,
                         const PointStresses& points, const RecoveryError& recovery,
                         const PeakStress& peak) {
  constexpr double kShare = 0.4, kFloor = 0.03, kSlope = 0.5, kCoarse = 23.0;
  if (!(peak.value > 0)) return 0.0;
  const double largest = largest_error_around(mesh, recovery, peak);
  const double spread =
      peak.triangle < 0 ? recovery_spread_inside(mesh, places, points, peak.element, peak.position)
                        : recovery_spread(mesh, places, points, peak.triangle, peak.reference);
  const double x = (spread + kShare * largest) / peak.value;
  return (std::sqrt(kFloor * kFloor + kSlope * kSlope * x * x) + kCoarse * x * x * x) * peak.value;
}

}  // namespace codesign::fem
