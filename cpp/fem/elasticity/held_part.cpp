#include "fem/elasticity/held_part.hpp"

#include <limits>
#include <utility>

#include "fem/stress/corner_stress.hpp"
#include "fem/stress/recovery.hpp"

namespace codesign::fem {

namespace {

void read_forces(const HeldPart& part, const Response& response, StaticResult& r) {
  r.reactions = Points::Zero(part.mesh.nodes.rows(), 3);
  r.support_forces = Points::Zero(static_cast<Eigen::Index>(part.supports.size()), 3);
  for (std::size_t d = 0; d < part.constraints.support.size(); ++d) {
    const int support = part.constraints.support[d];
    if (support < 0) continue;
    const Eigen::Index i = static_cast<Eigen::Index>(d);
    const double force = response.internal[i] - response.load[i];
    r.reactions(i / 3, i % 3) = force;
    r.support_forces(support, i % 3) += force;
  }
}

// What decides the safety factor, and its companion in a volume.
PeakStress read_peak(const HeldPart& part, const PointStresses& points, const ExclusionZone& zone,
                     StaticResult& r) {
  const double volume = part.settings.stress_volume / part.settings.copies;
  PeakStress peak = peak_stress(part.mesh, r.stress, zone);
  if (part.settings.exclusion == ExclusionRule::published) {
    r.stress_50 = stress_of_volume(part.mesh, points, part.clamped, zone.largest(), volume);
    return peak;
  }
  const VolumeStress inside = volume_stress(part.mesh, r.stress, points, zone, volume);
  r.stress_50 = inside.exceeded;
  return inside.largest.value > peak.value ? inside.largest : peak;
}

// Of all responses, recovered together.
std::vector<Stresses> nodal_stresses(const HeldPart& part,
                                     const std::vector<PointStresses>& points) {
  if (points.size() == 1) return {recover_stress(part.mesh, part.places, points[0])};
  const auto count = static_cast<Eigen::Index>(points.size());
  StressFields side_by_side(points[0].stress.rows(), 6 * count);
  for (Eigen::Index i = 0; i < count; ++i)
    side_by_side.middleCols<6>(6 * i) = points[static_cast<std::size_t>(i)].stress;
  const StressFields recovered = recover_fields(part.mesh, part.places, side_by_side);
  std::vector<Stresses> stresses;
  for (Eigen::Index i = 0; i < count; ++i) stresses.emplace_back(recovered.middleCols<6>(6 * i));
  return stresses;
}

void read_stress(const HeldPart& part, const Response& response, const PointStresses& points,
                 const Stresses& recovered, StaticResult& r) {
  const Eigen::VectorXd& u = response.displacement;
  r.stress = recovered;
  const CornerStress corners = corner_stress(part.mesh, part.places, part.material, u);
  r.stress(corners.nodes, Eigen::all) = corners.stress;
  r.von_mises = von_mises(r.stress);
  const ExclusionZone zone = exclusion_zone(part, response.loaded);
  const PeakStress peak = read_peak(part, points, zone, r);
  const PeakStress hidden = stress_left_out(part.mesh, r.stress, zone);
  if (hidden.triangle >= 0) {
    r.left_out = {hidden.value, hidden.position, zone.border_distance(hidden.position)};
  }
  r.counts_for_peak = counted_nodes(part.mesh, zone);
  r.exclusion_smallest = zone.smallest();
  r.exclusion_largest = zone.largest();
  RecoveryError recovery = recovery_error(part.mesh, part.material, u, r.stress);
  r.stress_error = peak_stress_error(part.mesh, part.places, points, recovery, peak);
  r.energy_error = recovery.relative_energy;
  r.element_error = std::move(recovery.element);
  r.peak_stress = peak.value;
  r.peak_position = peak.position;
  r.border_distance = zone.border_distance(peak.position);
  r.peak_at_exclusion = hidden.value > peak.value && beside_exclusion(part.mesh, peak, zone);
  r.safety_factor = peak.value > 0 ? part.material.yield_strength / peak.value
                                   : std::numeric_limits<double>::infinity();
}

}  // namespace

ExclusionZone exclusion_zone(const HeldPart& part, const std::vector<int>& loaded) {
  return {part.mesh,
          {part.clamped, symmetry_triangles(part.mesh, part.supports), loaded},
          {part.settings.exclusion, part.settings.exclusion_distance}};
}

std::vector<StaticResult> read_results(const HeldPart& part,
                                       const std::vector<Response>& responses) {
  std::vector<PointStresses> points;
  for (const Response& response : responses)
    points.push_back(point_stresses(part.mesh, part.material, response.displacement));
  const std::vector<Stresses> stresses = nodal_stresses(part, points);
  std::vector<StaticResult> results(responses.size());
  for (std::size_t i = 0; i < responses.size(); ++i) {
    const Eigen::VectorXd& u = responses[i].displacement;
    StaticResult& r = results[i];
    r.displacement = Eigen::Map<const Points>(u.data(), part.mesh.nodes.rows(), 3);
    r.max_displacement = r.displacement.rowwise().norm().maxCoeff();
    r.work = part.settings.copies * responses[i].load.dot(u);
    r.strain_energy = 0.5 * part.settings.copies * responses[i].internal.dot(u);
    read_forces(part, responses[i], r);
    read_stress(part, responses[i], points[i], stresses[i], r);
  }
  return results;
}

}  // namespace codesign::fem
