#pragma once

#include <vector>

#include "fem/size_field.hpp"
#include "fem/static_solver.hpp"
#include "fem/surface_mesh.hpp"
#include "fem/tet_mesh.hpp"
#include "fem/tet_mesher.hpp"

namespace codesign::fem {

// One part and one load case, ready to be meshed and solved; supports and loads name faces of the
// surface.
struct PartCase {
  SurfaceMesh surface;
  SizeField size;
  MeshOptions mesh_options;
  Material material;
  std::vector<Support> supports;
  std::vector<Load> loads;
  StaticSettings settings;
};

struct PartAnalysis {
  TetMesh mesh;
  StaticResult result;
  double mesh_seconds = 0.0;   // wall clock
  double solve_seconds = 0.0;  // order, assemble, factorise, solve, recover
};

// Surface to safety factor. Throws MeshError, SolverError, std::invalid_argument (unknown face).
PartAnalysis analyse_part(const PartCase& part);

}  // namespace codesign::fem
