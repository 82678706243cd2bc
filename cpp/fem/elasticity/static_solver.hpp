#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fem/boundary/loads.hpp"
#include "fem/boundary/remote_mass.hpp"
#include "fem/boundary/supports.hpp"
#include "fem/elasticity/buckling.hpp"
#include "fem/elasticity/memory.hpp"
#include "fem/elasticity/natural_modes.hpp"
#include "fem/elasticity/substructure.hpp"
#include "fem/mesh/material.hpp"
#include "fem/mesh/tet_mesh.hpp"
#include "fem/stress/peak_stress.hpp"
#include "fem/stress/stress.hpp"

// Linear elasticity of one part: find u with
//
//   div sigma(u) + b = 0 in the part,   sigma = lambda tr(e) I + 2 mu e,  e = sym grad u
//   components of u given on supports,  sigma n = t on loaded faces
//
// by quadratic tetrahedra: order, assemble, factorize, solve, check the residual, recover stress.
namespace codesign::fem {

// automatic: direct unless stiffness and factor are larger than the memory limit or the factor
// takes longer than conjugate gradients for all load cases; both are known before it is computed.
enum class LinearSolver { automatic, direct, iterative };

// How a model is solved and where its stress is read.
struct StaticSettings {
  ExclusionRule exclusion = ExclusionRule::local;
  std::optional<double> exclusion_distance;  // m, see ExclusionSettings
  double stress_volume = 50e-9;              // m³ of the whole part, see StaticResult::stress_50
  int copies = 1;                    // 2 for a half model: work and stress_volume count the part
  double residual_tolerance = 1e-9;  // relative
  LinearSolver solver = LinearSolver::automatic;
  double memory_limit = kMemoryLimit;  // bytes for matrices and factors
  int solutions = 1;                   // load cases that will be solved, for the automatic choice
  int eigenvalues = 0;                 // as many will be asked for: the choice leaves them room
};

// A part with its supports and loads.
struct StaticModel {
  TetMesh mesh;
  Material material;
  std::vector<Support> supports;
  std::vector<Load> loads;
  StaticSettings settings;
};

// The largest von Mises stress among what the exclusion leaves out.
struct LeftOut {
  double stress = 0.0;  // Pa; 0: nothing is left out
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double border_distance = 0.0;  // m, from the nearest border of a clamp or load
};

// What a load case does to a part.
struct StaticResult {
  Points displacement;            // (n, 3) m
  Stresses stress;                // (n, 6) Pa, recovered at the nodes
  Eigen::VectorXd von_mises;      // (n) Pa
  Points reactions;               // (n, 3) N, force of the supports on the part
  Points support_forces;          // (supports, 3) N, their sum over each support
  double work = 0.0;              // J: load times displacement, of the whole part
  double strain_energy = 0.0;     // J, of the whole part; half the work if no support is moved
  double max_displacement = 0.0;  // m
  double peak_stress = 0.0;       // Pa, see peak_stress.hpp
  double stress_error = 0.0;      // Pa, estimated error of peak_stress
  double energy_error = 0.0;      // estimated relative error in the energy norm
  Eigen::VectorXd element_error;  // (m) Pa, see RecoveryError
  Eigen::Vector3d peak_position = Eigen::Vector3d::Zero();
  double border_distance = 0.0;    // m, of peak_position from the nearest border of a clamp or load
  bool peak_at_exclusion = false;  // see beside_exclusion in peak_stress.hpp
  double stress_50 = 0.0;          // Pa, von Mises exceeded in stress_volume
  double safety_factor = 0.0;      // yield strength / peak_stress; infinite if nothing is stressed
  NodeFlags counts_for_peak;       // (n) see counted_nodes
  LeftOut left_out;
  double exclusion_smallest = 0.0, exclusion_largest = 0.0;  // m, of the distances kept
  double residual = 0.0;  // |K u - f| over the free components, relative to the larger of the
                          // load and the forces that flow through the nodes
  int equations = 0;
  int iterations = 0;  // of conjugate gradients; 0: solved by the factor

  // False if the estimated error exceeds half of the peak stress: the elements there are too coarse
  // to tell it.
  bool peak_resolved() const { return stress_error <= 0.5 * peak_stress; }
};

// What a model may spend on a factor before it is solved by iteration.
FactorLimits factor_limits(const StaticSettings& settings);

class UnitResponses;

// A model ordered, assembled and factorized once, for any number of load cases.
class StaticSystem {
 public:
  // masses: what faces of the part carry; accelerations pull at them and they count in the modes.
  // kept: of the same supports and material, elements of the mesh that need no factor of their own.
  // Throws SolverError naming the free rigid motions if the supports do not hold the part,
  // MemoryLimitError if no solver fits into the memory limit, and MeshError for inverted elements.
  StaticSystem(TetMesh mesh, Material material, std::vector<Support> supports,
               StaticSettings settings = {}, std::vector<RemoteMass> masses = {},
               std::shared_ptr<const KeptElements> kept = nullptr);
  ~StaticSystem();
  StaticSystem(StaticSystem&&) noexcept;
  StaticSystem& operator=(StaticSystem&&) noexcept;

  // Throws SolverError if the residual misses the tolerance, ModelError if nothing acts on the part
  // or a load acts on held components only.
  StaticResult solve(const std::vector<Load>& loads) const;

  // Several load cases, each as it is alone (within the residual's tolerance where elements are
  // kept, to the last digit otherwise), for less than one by one. Errors of several say which of
  // the names is meant.
  std::vector<StaticResult> solve_all(const std::vector<std::vector<Load>>& cases,
                                      const std::vector<std::string>& names) const;

  // The answers to unit loads (any number of loads each), see unit_responses.hpp; remote masses are
  // not in them, and a load of nothing is no error here. Throws SolverError as solve does,
  // ModelError if a support is moved.
  UnitResponses unit_responses(const std::vector<std::vector<Load>>& units) const;

  // The lowest modes on the supports, from the same factor if there is one. Throws SolverError,
  // std::invalid_argument: no density, count < 1.
  NaturalModes natural_modes(int count) const;

  // The displacement (n, 3) m of a load case alone. Throws SolverError as solve does.
  Points displacement(const std::vector<Load>& loads) const;

  // The lowest buckling modes under the load case that gives a displacement, from the same factor
  // if there is one. Throws SolverError, std::invalid_argument: count < 1.
  BucklingModes buckling_modes(const Points& displacement, int count) const;

  const TetMesh& mesh() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

// One load case of a model; throws as StaticSystem does.
StaticResult solve_static(const StaticModel& model);

}  // namespace codesign::fem
