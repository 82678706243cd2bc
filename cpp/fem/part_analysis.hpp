#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "fem/elasticity/static_solver.hpp"
#include "fem/elasticity/unit_responses.hpp"
#include "fem/mesh/tet_mesh.hpp"
#include "fem/meshing/size_field.hpp"
#include "fem/meshing/stretch.hpp"
#include "fem/meshing/tet_mesher.hpp"
#include "fem/peak_refinement.hpp"
#include "fem/surface/surface_mesh.hpp"

namespace codesign::fem {

// Loads that act together, and the safety factor that they ask for.
struct LoadCase {
  std::string name;
  std::vector<Load> loads;
  double least_safety_factor = 1.0;
  bool antisymmetric = false;  // of a half model: the other half's load is the mirror image, turned
};

// A load case that varies: unit loads, whose factors over time are not known yet (a flight gives
// them, say).
struct VaryingCase {
  std::string name;
  std::vector<std::vector<Load>> units;
};

// One part and its load cases, ready to be meshed and solved; supports and loads name faces of the
// surface. stretch: the part is the surface's body stretched; its mesh is that of the surface, and
// parts that differ by their stretch alone share it and most of its factor (kept_meshes.hpp).
struct PartCase {
  SurfaceMesh surface;
  SizeField size;
  std::optional<Stretch> stretch = std::nullopt;
  MeshOptions mesh_options;
  Material material;
  std::vector<Support> supports;
  std::vector<LoadCase> cases;
  std::vector<VaryingCase> varying;
  std::vector<RemoteMass> masses;
  StaticSettings settings;
  double tolerance = 0.05;  // wanted relative error of the peak stress, and so of the safety factor
  int max_refinements = 0;  // local refinements around peaks allowed to reach it; 0: one pass
  int modes = 0;            // natural frequencies wanted
  int buckling = 0;         // buckling factors wanted
};

// One factorization serves all load cases.
struct PartAnalysis {
  TetMesh mesh;
  std::vector<std::string> case_names;
  std::vector<StaticResult> results;  // one per load case
  std::size_t governing = 0;  // the case of the smallest safety factor over what it asks for

  const StaticResult& result() const { return results[governing]; }
  std::vector<UnitResponses> responses;  // to the unit loads of each varying case
  Eigen::VectorXd frequencies;           // (modes) Hz, ascending, of the whole part
  // (buckling) of the load, ascending, of the whole part and the case that buckles first; infinity
  // where there is none
  Eigen::VectorXd buckling_factors;
  SizeField size;          // that the mesh was made with
  bool converged = false;  // every case is settled; of one pass: estimated error of the governing
                           // one within the tolerance
  int refinements = 0;     // done
  std::vector<CaseConvergence> convergence;  // of each case; none if no refinement is allowed
  std::string failure;  // of a finer mesh that could not be made or solved; empty if all could
  std::string stopped;  // why refining ended without convergence, that maybe; empty otherwise
  double mesh_seconds = 0.0;   // wall clock, all passes
  double solve_seconds = 0.0;  // order, assemble, factorize, solve, recover; all passes
};

// Surface to safety factor. With refinements allowed, elements around the peak of every load case
// are halved at least once, in one mesh, until each case is settled; where that mesh cannot be made
// or solved, around the peak of the governing case alone. The mesher's time limit covers all
// passes. Throws MeshError, SolverError (MemoryLimitError, for want of memory too),
// std::invalid_argument (unknown face); if only a refined pass fails, the last result stands.
PartAnalysis analyze_part(const PartCase& part);

}  // namespace codesign::fem
