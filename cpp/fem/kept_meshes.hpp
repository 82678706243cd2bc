#pragma once

#include <memory>

#include "fem/boundary/supports.hpp"
#include "fem/elasticity/substructure.hpp"
#include "fem/mesh/material.hpp"
#include "fem/mesh/tet_mesh.hpp"
#include "fem/meshing/mesh_options.hpp"
#include "fem/meshing/size_field.hpp"
#include "fem/meshing/stretch.hpp"
#include "fem/surface/surface_mesh.hpp"

// Meshes of this process, and the factors of what stretching them leaves as it is, by what they
// were made from: designs that differ by a stretch share one mesh and most of the work. A result
// never depends on what is kept, only its time does. Safe for several threads.
namespace codesign::fem {

// What may be kept in all, 256 MB at first. Factors go before meshes: first those that save least
// for their size, as long as they are not used; of the meshes the longest unused. With 0 nothing
// stays but the last mesh.
void limit_kept_meshes(double bytes);

// Whether there was anything to forget.
bool forget_meshes();

// The mesh of a surface, made now or before. Throws as tetrahedralize does.
std::shared_ptr<const TetMesh> kept_mesh(const SurfaceMesh& surface, const SizeField& size,
                                         const MeshOptions& options);

// What stretching leaves of a mesh that was got from `kept_mesh`, factorized now or before; nothing
// where a factor of it would not fit into the limits.
std::shared_ptr<const KeptElements> kept_elements(const std::shared_ptr<const TetMesh>& mesh,
                                                  const Stretch& stretch, const Material& material,
                                                  const Constraints& constraints,
                                                  const FactorLimits& limits);

}  // namespace codesign::fem
