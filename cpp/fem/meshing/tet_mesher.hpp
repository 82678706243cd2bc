#pragma once

#include "fem/mesh/tet_mesh.hpp"
#include "fem/meshing/mesh_options.hpp"
#include "fem/meshing/size_field.hpp"
#include "fem/surface/surface_mesh.hpp"

namespace codesign::fem {

// Quadratic tetrahedra of the solid inside `surface`; edge lengths follow `size`.
// Edges sharper than the feature angle and all borders between different faces are lines of the
// mesh; each boundary side carries the face of the surface it lies on. The same input gives the
// same mesh. Throws MeshError: a surface that bounds no solid (check_surface), a mesh that is
// empty, in several pieces, of wrong volume or area, or lacks a face, too many vertices, time limit
// reached; std::invalid_argument: options out of range.
// Source: CGAL 3D Mesh Generation (Delaunay refinement with protecting balls on features).
TetMesh tetrahedralize(const SurfaceMesh& surface, const SizeField& size,
                       const MeshOptions& options = {});

}  // namespace codesign::fem
