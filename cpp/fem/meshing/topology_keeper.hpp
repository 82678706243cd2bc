#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "fem/mesh/tet_mesh.hpp"
#include "fem/meshing/delaunay_mesher.hpp"
#include "fem/meshing/mesh_options.hpp"
#include "fem/meshing/prepared_surface.hpp"
#include "fem/meshing/size_field.hpp"
#include "fem/meshing/surface_match.hpp"
#include "fem/meshing/wall_samples.hpp"

namespace codesign::fem {

// Compares the boundary of a mesh with the surface: as many closed pieces, each of the same Euler
// characteristic, manifold. Where they differ it asks for another mesh, made with more care and
// with smaller elements there, a few times. Places where the boundary touches itself, no larger
// than what surfaces are simplified by (0.05 mm, 0.0005 of the extent), are only counted if the
// solid has the Euler characteristic that the surface bounds: they sit on ledges of that size,
// which elements cannot follow at any edge length.
class TopologyKeeper {
 public:
  // `prepared` must outlive the keeper.
  TopologyKeeper(const PreparedSurface& prepared, const SizeField& size,
                 const MeshOptions& options);

  // What the next mesh is to be made with.
  const SizeField& size() const { return size_; }
  Attempt attempt() const { return {round_ > 0, round_ > 0, breakdowns_ > 0}; }

  // Whether the mesh has the topology of the surface; if not, the size is smaller afterwards.
  // mesh.boundary_face: patches. Throws MeshError, with a place, after the last round.
  bool accepts(const TetMesh& mesh);

  // Asks for another mesh with slightly smaller elements everywhere, as the refinement broke down.
  // Throws MeshError with `reason` after the last time.
  void retry(const std::string& reason);

  // What a mesh of another topology could not be refined for; the reason alone if there was none.
  std::string explain(const std::string& reason) const;

  // Completes the report of an accepted mesh.
  void report(TetMesh& mesh) const;

 private:
  const PreparedSurface& prepared_;
  SizeField size_;
  MeshOptions options_;
  int round_ = 0;
  int breakdowns_ = 0;
  int small_ = 0;                  // faults that the solid does not know of
  std::string mismatch_;           // of the last mesh and where; empty before the first one
  std::vector<WallSample> walls_;  // once a mesh was refused
};

}  // namespace codesign::fem
