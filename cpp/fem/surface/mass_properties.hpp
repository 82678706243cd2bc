#pragma once

#include <Eigen/Core>

#include "fem/surface/surface_mesh.hpp"

namespace codesign::fem {

// Mass properties of a solid.
struct MassProperties {
  double volume;            // m³
  double mass;              // kg
  Eigen::Vector3d com;      // m, axes and origin of the surface
  Eigen::Matrix3d inertia;  // kg m², about the center of mass, axes of the surface; tensor entries
                            // (Ixy = -integral of x y dm, as in URDF)
};

// Mass, center of mass and inertia of a closed surface filled with `density` [kg/m³], exact for the
// polyhedron: the volume integrals of 1, x, x² are sums over the tetrahedra spanned by each
// triangle and a common apex (divergence theorem). Throws MeshError if the surface is not closed,
// oriented and of positive volume; std::invalid_argument if density <= 0. Source: A. M. Messner, G.
// Q. Taylor, ACM TOMS 6 (1980), algorithm 550; formulas derived anew.
MassProperties mass_properties(const SurfaceMesh& surface, double density);

}  // namespace codesign::fem
