#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "fem/mesh/tet_mesh.hpp"
#include "fem/stress/surface_distance.hpp"

namespace codesign::fem {

// Where the peak stress is not read, because the stress of a linear elastic model grows without end
// there under refinement.
//
// local: around borders of clamps, within kFeatureShare of the local feature (wall, hole, fillet or
// the clamp itself, see local_feature.hpp); around re-entrant sharp edges that border a loaded face
// (a pocket's edge) within 3 mm, or a tenth of the extent of a part smaller than 30 mm. The border
// of a load on a smooth face is not left out: the stress there is bounded.
// published: the same distance everywhere, 3 mm unless given, from clamped faces and from borders
// of loaded faces of any kind; the rule of the published study.
enum class ExclusionRule { local, published };

// A rule, and the distance that it keeps.
struct ExclusionSettings {
  ExclusionRule rule = ExclusionRule::local;
  std::optional<double> distance;  // m, the same everywhere; the rule's own if absent
};

// Boundary triangles of a model, each sorted.
struct HeldAndLoaded {
  std::vector<int> clamped;
  std::vector<int> symmetric;  // cut plane of a half model
  std::vector<int> loaded;
};

// The places of one model that a rule leaves out.
class ExclusionZone {
 public:
  static constexpr double kPublishedDistance = 3e-3;  // m
  static constexpr double kFeatureShare = 0.2;
  static constexpr double kSharpBend = 0.5235987755982988;  // 30 degrees

  ExclusionZone(const TetMesh& mesh, const HeldAndLoaded& faces, const ExclusionSettings& settings);

  // True for a boundary triangle that is left out as a whole, wherever its points are.
  bool skips(int triangle) const;

  // True if the point is left out.
  bool contains(const Eigen::Vector3d& point) const { return near_.within(point); }

  // True if every point of a ball is surely left out; if some may be.
  bool contains_ball(const Eigen::Vector3d& center, double radius) const {
    return near_.within(center, -radius);
  }
  bool touches_ball(const Eigen::Vector3d& center, double radius) const {
    return !near_.empty() && near_.within(center, radius);
  }

  // From the nearest border of a clamp or load; infinite if there is none. [m]
  double border_distance(const Eigen::Vector3d& point) const { return borders_.distance(point); }

  // Of the distances that are kept. [m]
  double smallest() const { return near_.smallest_reach(); }
  double largest() const { return near_.largest_reach(); }

 private:
  void set_published(const TetMesh& mesh, const HeldAndLoaded& faces, double distance);
  void set_local(const TetMesh& mesh, const HeldAndLoaded& faces, std::optional<double> distance);

  SurfaceDistance near_, borders_;
  std::vector<char> skipped_;
};

using NodeFlags = Eigen::Array<bool, Eigen::Dynamic, 1>;

// Of every node, whether the peak stress may be read there: it lies outside the zone and, on the
// surface, on a triangle that is not left out as a whole.
NodeFlags counted_nodes(const TetMesh& mesh, const ExclusionZone& zone);

}  // namespace codesign::fem
