#include "fem/elasticity/static_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "errors.hpp"
#include "fem/boundary/rigid_motions.hpp"
#include "fem/elasticity/nodal_matrices.hpp"
#include "fem/elasticity/stiffness.hpp"
#include "fem/elasticity/two_level.hpp"
#include "fem/la/cholesky.hpp"
#include "fem/la/ordering.hpp"
#include "fem/stress/recovery.hpp"
#include "model_error.hpp"

namespace codesign::fem {

namespace {

constexpr int kMaxRefinements = 3;
constexpr double kGradientTolerance = 1e-11;  // of conjugate gradients, see there
constexpr int kMaxIterations = 500;
// Multiply-adds of a factorisation that takes as long as conjugate gradients on the same part.
constexpr double kDirectOperations = 1.5e10;

void check_mesh(const TetMesh& mesh) {
  if (mesh.tets.rows() == 0) throw MeshError("the mesh has no elements");
  if (!mesh.nodes.allFinite()) throw MeshError("the mesh has nodes that are not finite");
  if (mesh.tets.minCoeff() < 0 || mesh.tets.maxCoeff() >= mesh.nodes.rows() ||
      (mesh.boundary.size() > 0 &&
       (mesh.boundary.minCoeff() < 0 || mesh.boundary.maxCoeff() >= mesh.nodes.rows()))) {
    throw MeshError("the mesh refers to nodes that do not exist");
  }
}

void check_settings(const StaticSettings& s) {
  if (!(s.exclusion_distance.value_or(0.0) >= 0))
    throw std::invalid_argument("exclusion_distance must be >= 0");
  if (!(s.stress_volume > 0)) throw std::invalid_argument("stress_volume must be > 0");
  if (s.copies < 1) throw std::invalid_argument("copies must be >= 1");
  if (!(s.residual_tolerance > 0)) throw std::invalid_argument("residual_tolerance must be > 0");
}

bool solves_directly(const NodePattern& pattern, const StaticSettings& settings) {
  if (settings.solver != LinearSolver::automatic) return settings.solver == LinearSolver::direct;
  return factor_fits(pattern, settings.memory_limit, kDirectOperations);
}

}  // namespace

struct StaticSystem::Data {
  TetMesh mesh;
  Material material;
  std::vector<Support> supports;
  StaticSettings settings;
  Constraints constraints;
  NodePattern pattern;
  std::unique_ptr<CholeskyFactor> factor;  // or, if it would be too large:
  LowerMatrix stiffness;
  std::unique_ptr<TwoLevelPreconditioner> preconditioner;
  std::vector<int> clamped;

  // Whether eigenvalues are worth a factor although one load case was not.
  bool refactors() const {
    return !factor && settings.solver == LinearSolver::automatic &&
           factor_fits(pattern, settings.memory_limit, kEigenOperations);
  }

  Eigen::VectorXd gather(const Eigen::VectorXd& nodal) const {
    Eigen::VectorXd result(pattern.equations());
    for (std::size_t d = 0; d < pattern.equation.size(); ++d) {
      if (pattern.equation[d] >= 0) result[pattern.equation[d]] = nodal[static_cast<int>(d)];
    }
    return result;
  }

  void add_free(const Eigen::VectorXd& free, Eigen::VectorXd& nodal) const {
    for (std::size_t d = 0; d < pattern.equation.size(); ++d) {
      if (pattern.equation[d] >= 0) nodal[static_cast<int>(d)] += free[pattern.equation[d]];
    }
  }

  Eigen::VectorXd solve_free(const Eigen::VectorXd& force, int& iterations) const {
    if (factor) return factor->solve(force);
    ConjugateGradientResult result =
        conjugate_gradients(stiffness, *preconditioner, force, kGradientTolerance, kMaxIterations);
    iterations += result.iterations;
    return std::move(result.solution);
  }

  // Displacement with iterative refinement; internal is left as its internal forces.
  Eigen::VectorXd displace(const Eigen::VectorXd& load, Eigen::VectorXd& internal, double& residual,
                           int& iterations) const {
    Eigen::VectorXd u = constraints.displacement;
    internal = internal_forces(mesh, material, u).sum;
    residual = 0.0;
    if (pattern.equations() == 0) return u;
    if (load.isZero(0.0) && internal.isZero(0.0)) return u;
    for (int step = 0; step <= kMaxRefinements; ++step) {
      const Eigen::VectorXd correction = solve_free(gather(load - internal), iterations);
      add_free(correction, u);
      InternalForces forces = internal_forces(mesh, material, u);
      internal = std::move(forces.sum);
      const double scale = std::max(load.norm(), forces.size.norm());
      residual = gather(load - internal).norm() / scale;
      if (residual <= settings.residual_tolerance) return u;
    }
    std::ostringstream text;
    text << "the relative residual " << residual << " misses the tolerance "
         << settings.residual_tolerance << ": the model is too badly conditioned";
    throw SolverError(text.str());
  }

  void read_forces(const Eigen::VectorXd& load, const Eigen::VectorXd& internal,
                   StaticResult& r) const {
    r.reactions = Points::Zero(mesh.nodes.rows(), 3);
    r.support_forces = Points::Zero(static_cast<Eigen::Index>(supports.size()), 3);
    for (std::size_t d = 0; d < constraints.support.size(); ++d) {
      const int support = constraints.support[d];
      if (support < 0) continue;
      const Eigen::Index i = static_cast<Eigen::Index>(d);
      r.reactions(i / 3, i % 3) = internal[i] - load[i];
      r.support_forces(support, i % 3) += internal[i] - load[i];
    }
  }

  // A load that no free component feels, or loads that cancel, would silently do nothing.
  void require_effect(const std::vector<Load>& loads, const Eigen::VectorXd& total) const {
    constexpr double kRoundOff = 1e-12;
    double largest = 0.0;
    for (std::size_t i = 0; i < loads.size(); ++i) {
      const Eigen::VectorXd load =
          loads.size() == 1 ? total : load_vector(mesh, material, {loads[i]});
      const double size = load.cwiseAbs().maxCoeff();
      largest = std::max(largest, size);
      const Eigen::VectorXd felt = gather(load);
      if (size == 0.0 || (felt.size() > 0 && felt.cwiseAbs().maxCoeff() > kRoundOff * size)) {
        continue;
      }
      throw ModelError("load " + std::to_string(i + 1) + " of " + std::to_string(loads.size()) +
                       " acts on held faces only and has no effect: move it off the supports, or "
                       "hold less");
    }
    if (total.cwiseAbs().maxCoeff() <= kRoundOff * largest &&
        constraints.displacement.isZero(0.0)) {
      throw ModelError(loads.empty() ? "nothing acts on the part: give a load, or a displacement "
                                       "of a support"
                                     : "the loads add up to nothing: no node is loaded");
    }
  }

  // What decides the safety factor, and its companion in a volume.
  PeakStress read_peak(const PointStresses& points, const ExclusionZone& zone,
                       StaticResult& r) const {
    const double volume = settings.stress_volume / settings.copies;
    PeakStress peak = codesign::fem::peak_stress(mesh, r.stress, zone);
    if (settings.exclusion == ExclusionRule::published) {
      r.stress_50 = stress_of_volume(mesh, points, clamped, zone.largest(), volume);
      return peak;
    }
    const VolumeStress inside = volume_stress(mesh, r.stress, points, zone, volume);
    r.stress_50 = inside.exceeded;
    return inside.largest.value > peak.value ? inside.largest : peak;
  }

  void read_stress(const std::vector<Load>& loads, const Eigen::VectorXd& u,
                   StaticResult& r) const {
    const PointStresses points = point_stresses(mesh, material, u);
    r.stress = recover_stress(mesh, points);
    r.von_mises = codesign::fem::von_mises(r.stress);
    const ExclusionZone zone(
        mesh, {clamped, symmetry_triangles(mesh, supports), loaded_triangles(mesh, loads)},
        {settings.exclusion, settings.exclusion_distance});
    const PeakStress peak = read_peak(points, zone, r);
    const PeakStress hidden = stress_left_out(mesh, r.stress, zone);
    if (hidden.triangle >= 0) {
      r.left_out = {hidden.value, hidden.position, zone.border_distance(hidden.position)};
    }
    r.counts_for_peak = counted_nodes(mesh, zone);
    r.exclusion_smallest = zone.smallest();
    r.exclusion_largest = zone.largest();
    RecoveryError recovery = recovery_error(mesh, material, u, r.stress);
    r.stress_error = peak_stress_error(mesh, points, recovery, peak);
    r.energy_error = recovery.relative_energy;
    r.element_error = std::move(recovery.element);
    r.peak_stress = peak.value;
    r.peak_position = peak.position;
    r.safety_factor = peak.value > 0 ? material.yield_strength / peak.value
                                     : std::numeric_limits<double>::infinity();
  }
};

StaticSystem::StaticSystem(TetMesh mesh, Material material, std::vector<Support> supports,
                           StaticSettings settings)
    : data_(std::make_unique<Data>()) {
  check_mesh(mesh);
  check_material(material);
  check_settings(settings);
  Data& d = *data_;
  d.mesh = std::move(mesh);
  d.material = std::move(material);
  d.supports = std::move(supports);
  d.settings = settings;
  d.constraints = constrain(d.mesh, d.supports);
  require_held(d.mesh, d.constraints);
  d.clamped = clamped_triangles(d.mesh, d.supports);
  d.pattern = order_nodes(d.mesh, d.constraints);
  if (d.pattern.equations() == 0) return;
  const bool direct = solves_directly(d.pattern, settings);
  require_memory(matrix_bytes(d.pattern) + (direct ? factor_bytes(d.pattern) : 0.0),
                 settings.memory_limit, static_cast<int>(d.mesh.nodes.rows()));
  LowerMatrix stiffness = assemble_stiffness(d.mesh, d.material, d.pattern);
  if (direct) {
    d.factor = std::make_unique<CholeskyFactor>(d.pattern, stiffness);
  } else {
    d.stiffness = std::move(stiffness);
    d.preconditioner = std::make_unique<TwoLevelPreconditioner>(
        d.mesh, d.material, d.constraints, d.pattern, d.stiffness, settings.memory_limit);
  }
}

StaticSystem::~StaticSystem() = default;
StaticSystem::StaticSystem(StaticSystem&&) noexcept = default;
StaticSystem& StaticSystem::operator=(StaticSystem&&) noexcept = default;

const TetMesh& StaticSystem::mesh() const { return data_->mesh; }

StaticResult StaticSystem::solve(const std::vector<Load>& loads) const {
  const Data& d = *data_;
  const Eigen::VectorXd load = load_vector(d.mesh, d.material, loads);
  d.require_effect(loads, load);
  StaticResult r;
  Eigen::VectorXd internal;
  const Eigen::VectorXd u = d.displace(load, internal, r.residual, r.iterations);
  r.displacement = Eigen::Map<const Points>(u.data(), d.mesh.nodes.rows(), 3);
  r.max_displacement = r.displacement.rowwise().norm().maxCoeff();
  r.work = d.settings.copies * load.dot(u);
  r.strain_energy = 0.5 * d.settings.copies * internal.dot(u);
  r.equations = d.pattern.equations();
  d.read_forces(load, internal, r);
  d.read_stress(loads, u, r);
  return r;
}

NaturalModes StaticSystem::natural_modes(int count) const {
  const Data& d = *data_;
  if (d.refactors()) {
    return codesign::fem::natural_modes(d.mesh, d.material, d.supports, count,
                                        d.settings.memory_limit);
  }
  if (!(d.material.density > 0)) throw std::invalid_argument("modes need a density above 0");
  if (!d.factor) {
    return modes_by_iteration(d.pattern, assemble_nodal_mass(d.mesh, d.material, d.pattern),
                              d.stiffness, *d.preconditioner, 0.0, count);
  }
  return modes_of_factor(d.pattern, assemble_mass(d.mesh, d.material, d.pattern), *d.factor, 0.0,
                         count);
}

Points StaticSystem::displacement(const std::vector<Load>& loads) const {
  const Data& d = *data_;
  const Eigen::VectorXd load = load_vector(d.mesh, d.material, loads);
  d.require_effect(loads, load);
  Eigen::VectorXd internal;
  double residual = 0.0;
  int iterations = 0;
  const Eigen::VectorXd u = d.displace(load, internal, residual, iterations);
  return Eigen::Map<const Points>(u.data(), d.mesh.nodes.rows(), 3);
}

BucklingModes StaticSystem::buckling_modes(const Points& displacement, int count) const {
  const Data& d = *data_;
  if (d.refactors()) {
    return codesign::fem::buckling_modes(d.mesh, d.material, d.supports, displacement, count,
                                         d.settings.memory_limit);
  }
  if (!d.factor) {
    return buckling_by_iteration(d.mesh, d.material, d.pattern, d.stiffness, *d.preconditioner,
                                 displacement, count);
  }
  return buckling_of_factor(d.mesh, d.material, d.pattern, *d.factor, displacement, count);
}

StaticResult solve_static(const StaticModel& model) {
  return StaticSystem(model.mesh, model.material, model.supports, model.settings)
      .solve(model.loads);
}

}  // namespace codesign::fem
