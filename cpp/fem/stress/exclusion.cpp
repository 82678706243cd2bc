#include "fem/stress/exclusion.hpp"

#include <algorithm>

#include "fem/stress/local_feature.hpp"

namespace codesign::fem {

ExclusionZone::ExclusionZone(const TetMesh& mesh, const HeldAndLoaded& faces,
                             const ExclusionSettings& settings)
    : skipped_(static_cast<std::size_t>(mesh.boundary.rows()), 0) {
  if (settings.rule == ExclusionRule::published) {
    set_published(mesh, faces, settings.distance.value_or(kPublishedDistance));
  } else {
    set_local(mesh, faces, settings.distance);
  }
  near_.sort_pieces();
  borders_.sort_pieces();
}

bool ExclusionZone::skips(int triangle) const {
  return skipped_[static_cast<std::size_t>(triangle)] != 0;
}

void ExclusionZone::set_published(const TetMesh& mesh, const HeldAndLoaded& faces,
                                  double distance) {
  const Neighbors neighbors = boundary_neighbors(mesh);
  const std::vector<BorderEdge> held = border_edges(neighbors, faces.clamped, {}),
                                loaded = border_edges(neighbors, faces.loaded, {});
  for (const auto* edges : {&held, &loaded}) {
    for (const BorderEdge& e : *edges) borders_.add_edge(mesh, e.inside, e.side, 0.0);
  }
  if (!(distance > 0)) return;
  for (const int t : faces.clamped) {
    near_.add_triangle(mesh, t, distance);
    skipped_[static_cast<std::size_t>(t)] = 1;
  }
  for (const BorderEdge& e : loaded) near_.add_edge(mesh, e.inside, e.side, distance);
}

void ExclusionZone::set_local(const TetMesh& mesh, const HeldAndLoaded& faces,
                              std::optional<double> distance) {
  const Neighbors neighbors = boundary_neighbors(mesh);
  std::vector<BorderEdge> held = border_edges(neighbors, faces.clamped, faces.symmetric);
  const std::vector<double> features =
      distance ? std::vector<double>(held.size())
               : local_features(mesh, neighbors, faces.clamped, held, kFeatureShare);
  for (std::size_t i = 0; i < held.size(); ++i) {
    const double reach = distance.value_or(kFeatureShare * features[i]);
    borders_.add_edge(mesh, held[i].inside, held[i].side, 0.0);
    if (reach > 0) near_.add_edge(mesh, held[i].inside, held[i].side, reach);
  }
  const double pocket = distance.value_or(std::min(kPublishedDistance, 0.1 * extent(mesh.nodes)));
  for (const BorderEdge& e : border_edges(neighbors, faces.loaded, faces.symmetric)) {
    borders_.add_edge(mesh, e.inside, e.side, 0.0);
    if (pocket > 0 && is_sharp_pocket(mesh, e, kSharpBend)) {
      near_.add_edge(mesh, e.inside, e.side, pocket);
    }
  }
}

NodeFlags counted_nodes(const TetMesh& mesh, const ExclusionZone& zone) {
  NodeFlags skipped = NodeFlags::Constant(mesh.nodes.rows(), false), kept = skipped;
  for (int t = 0; t < mesh.boundary.rows(); ++t) {
    NodeFlags& flags = zone.skips(t) ? skipped : kept;
    for (int k = 0; k < mesh.boundary.cols(); ++k) flags[mesh.boundary(t, k)] = true;
  }
  NodeFlags counted = kept || !skipped;
  for (int i = 0; i < mesh.nodes.rows(); ++i) {
    counted[i] = counted[i] && !zone.contains(mesh.nodes.row(i).transpose());
  }
  return counted;
}

}  // namespace codesign::fem
