#include "fem/elasticity/static_solver.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "errors.hpp"
#include "fem/boundary/rigid_motions.hpp"
#include "fem/elasticity/condensed_solution.hpp"
#include "fem/elasticity/held_part.hpp"
#include "fem/elasticity/nodal_matrices.hpp"
#include "fem/elasticity/stiffness.hpp"
#include "fem/elasticity/two_level.hpp"
#include "fem/elasticity/unit_responses.hpp"
#include "fem/la/cholesky.hpp"
#include "fem/la/ordering.hpp"
#include "model_error.hpp"

namespace codesign::fem {

namespace {

constexpr int kMaxRefinements = 3;
constexpr double kSuperposed = 1e-3;  // of the tolerance: for solutions whose sum may be small
constexpr double kRoundOff = 1e-12;   // of loads, relative
constexpr double kGradientTolerance = 1e-11;  // of conjugate gradients, see there
constexpr int kMaxIterations = 500;
// Multiply-adds of a factorization that takes as long as conjugate gradients on the same part.
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
  if (s.solutions < 1) throw std::invalid_argument("solutions must be >= 1");
  if (s.eigenvalues < 0) throw std::invalid_argument("eigenvalues must be >= 0");
  if (!(s.residual_tolerance > 0)) throw std::invalid_argument("residual_tolerance must be > 0");
}

int free_components(const Constraints& constraints) {
  return static_cast<int>(std::count(constraints.fixed.begin(), constraints.fixed.end(), char{0}));
}

bool solves_directly(const NodePattern& pattern, const StaticSettings& settings) {
  const bool chooses = settings.solver == LinearSolver::automatic;
  if (chooses && settings.eigenvalues > 0 &&
      matrix_bytes(pattern) + factor_bytes(pattern) + eigen_bytes(pattern, settings.eigenvalues) >
          settings.memory_limit)
    return false;
  if (settings.solver != LinearSolver::automatic) return settings.solver == LinearSolver::direct;
  return factor_fits(pattern, factor_limits(settings));
}

// A load case that is a multiple of an earlier one, or of itself.
struct Multiple {
  std::size_t of;
  double factor = 1.0;
};

std::vector<Multiple> multiples(const std::vector<Response>& responses,
                                const Constraints& constraints) {
  std::vector<Multiple> found;
  for (std::size_t i = 0; i < responses.size(); ++i) {
    found.push_back({i});
    if (!constraints.displacement.isZero(0.0)) continue;
    for (std::size_t j = 0; j < i; ++j) {
      const Eigen::VectorXd &load = responses[i].load, &other = responses[j].load;
      const double factor = load.dot(other) / other.squaredNorm();
      if (found[j].of != j || responses[i].loaded != responses[j].loaded || !(factor > 0.0) ||
          (load - factor * other).norm() > kRoundOff * load.norm())
        continue;
      found.back() = {j, factor};
      break;
    }
  }
  return found;
}

// The answer to a load times a factor > 0.
StaticResult scaled(StaticResult r, double factor) {
  r.displacement *= factor;
  r.stress *= factor;
  r.von_mises *= factor;
  r.reactions *= factor;
  r.support_forces *= factor;
  r.element_error *= factor;
  for (double* value :
       {&r.max_displacement, &r.peak_stress, &r.stress_error, &r.stress_50, &r.left_out.stress})
    *value *= factor;
  r.work *= factor * factor;
  r.strain_energy *= factor * factor;
  r.safety_factor /= factor;
  return r;
}

}  // namespace

FactorLimits factor_limits(const StaticSettings& settings) {
  return {settings.memory_limit, settings.solutions * kDirectOperations};
}

struct StaticSystem::Data {
  std::shared_ptr<const HeldPart> part;
  int equations = 0;
  std::unique_ptr<CondensedFactor> condensed;  // or, if no element is kept:
  NodePattern pattern;
  std::unique_ptr<CholeskyFactor> factor;  // or, if it would be too large:
  LowerMatrix stiffness;
  std::unique_ptr<TwoLevelPreconditioner> preconditioner;

  // Whether eigenvalues are worth a factor although one load case was not.
  bool refactors() const {
    if (condensed) return true;
    return !factor && part->settings.solver == LinearSolver::automatic &&
           factor_fits(pattern, {part->settings.memory_limit, kEigenOperations});
  }

  // Of the memory limit, beside what the solution by iteration holds. [bytes]
  double memory_left() const {
    if (condensed) return part->settings.memory_limit;
    return part->settings.memory_limit - matrix_bytes(pattern) - preconditioner->bytes();
  }

  Eigen::VectorXd gather(const Eigen::VectorXd& nodal) const {
    Eigen::VectorXd result(pattern.equations());
    for (std::size_t d = 0; d < pattern.equation.size(); ++d) {
      if (pattern.equation[d] >= 0) result[pattern.equation[d]] = nodal[static_cast<int>(d)];
    }
    return result;
  }

  // A factor made where conjugate gradients do not converge, as with elements of extreme shape.
  using Rescue = std::unique_ptr<CholeskyFactor>;
  Eigen::VectorXd solve_free(const Eigen::VectorXd& force, int& iterations, Rescue& rescue) const {
    if (factor) return factor->solve(force);
    if (rescue) return rescue->solve(force);
    ConjugateGradientResult result =
        conjugate_gradients(stiffness, *preconditioner, force, kGradientTolerance, kMaxIterations);
    iterations += result.iterations;
    if (result.converged || part->settings.solver != LinearSolver::automatic ||
        factor_bytes(pattern) > memory_left())
      return std::move(result.solution);
    rescue = std::make_unique<CholeskyFactor>(pattern, stiffness);
    return rescue->solve(force);
  }

  // Of nodal components (3 n), zero where held.
  Eigen::VectorXd solve_nodal(const Eigen::VectorXd& force, int& iterations, Rescue& rescue) const {
    if (condensed) return condensed->solve(force);
    return nodal_columns(pattern, solve_free(gather(force), iterations, rescue));
  }

  // One column of loads: (3 n) N, and what they do.
  struct Displaced {
    Eigen::VectorXd displacement, internal;
    double residual = 0.0;
    int iterations = 0;
  };

  // Displacements with iterative refinement, each column as it would be alone; a condensed factor's
  // are within a share of the tolerance.
  std::vector<Displaced> displace(const Eigen::MatrixXd& loads, double share = 1.0) const {
    const double tolerance = part->settings.residual_tolerance;
    std::vector<Displaced> all(static_cast<std::size_t>(loads.cols()));
    Rescue rescue;
    Eigen::MatrixXd u = part->constraints.displacement.replicate(1, loads.cols());
    if (condensed)
      u = condensed_solution(*condensed, part->mesh, part->material, part->constraints, loads,
                             share * tolerance);
    for (int solves = condensed ? 1 : 0;; ++solves) {
      const InternalForces forces =
          u.isZero(0.0) ? InternalForces{u, u} : internal_forces(part->mesh, part->material, u);
      bool done = true;
      for (Eigen::Index i = 0; i < loads.cols(); ++i) {
        Displaced& one = all[static_cast<std::size_t>(i)];
        const Eigen::VectorXd left = felt(part->constraints, loads.col(i) - forces.sum.col(i));
        const double scale = std::max(loads.col(i).norm(), forces.size.col(i).norm());
        one.residual = scale > 0.0 ? left.norm() / scale : 0.0;
        if (one.residual <= tolerance || equations == 0) continue;
        if (solves > kMaxRefinements) refuse(one.residual);
        u.col(i) += solve_nodal(loads.col(i) - forces.sum.col(i), one.iterations, rescue);
        done = false;
      }
      if (!done) continue;
      for (Eigen::Index i = 0; i < loads.cols(); ++i) {
        all[static_cast<std::size_t>(i)].displacement = u.col(i);
        all[static_cast<std::size_t>(i)].internal = forces.sum.col(i);
      }
      return all;
    }
  }

  // What responses, of which the loads are known, do to the part.
  std::vector<StaticResult> answers(std::vector<Response> responses) const {
    Eigen::MatrixXd loads(responses[0].load.size(), static_cast<Eigen::Index>(responses.size()));
    for (std::size_t i = 0; i < responses.size(); ++i)
      loads.col(static_cast<Eigen::Index>(i)) = responses[i].load;
    std::vector<Displaced> displaced = displace(loads);
    for (std::size_t i = 0; i < responses.size(); ++i) {
      responses[i].displacement = std::move(displaced[i].displacement);
      responses[i].internal = std::move(displaced[i].internal);
    }
    std::vector<StaticResult> results = read_results(*part, responses);
    for (std::size_t i = 0; i < results.size(); ++i) {
      results[i].residual = displaced[i].residual;
      results[i].iterations = displaced[i].iterations;
      results[i].equations = equations;
    }
    return results;
  }

  [[noreturn]] void refuse(double residual) const {
    std::ostringstream text;
    text << "the relative residual " << residual << " misses the tolerance "
         << part->settings.residual_tolerance << ": the model is too badly conditioned";
    throw SolverError(text.str());
  }

  // Throws ModelError for loads without effect.
  Response loaded(const std::vector<Load>& given) const {
    const std::vector<Load> loads = with_masses(given, part->masses);
    Response response;
    response.loaded = loaded_triangles(part->mesh, loads);
    response.load = Eigen::VectorXd::Zero(3 * part->mesh.nodes.rows());
    double largest = 0.0;
    for (std::size_t i = 0; i < loads.size(); ++i) {
      const Eigen::VectorXd load = load_vector(part->mesh, part->material, {loads[i]});
      require_felt(load, i, loads.size());
      largest = std::max(largest, load.cwiseAbs().maxCoeff());
      response.load += load;
    }
    if (response.load.cwiseAbs().maxCoeff() <= kRoundOff * largest &&
        part->constraints.displacement.isZero(0.0)) {
      throw ModelError(loads.empty() ? "nothing acts on the part: give a load, or a displacement "
                                       "of a support"
                                     : "the loads add up to nothing: no node is loaded");
    }
    return response;
  }

  // A load that no free component feels would silently do nothing.
  void require_felt(const Eigen::VectorXd& load, std::size_t i, std::size_t count) const {
    const double size = load.cwiseAbs().maxCoeff();
    if (size == 0.0 || felt(part->constraints, load).cwiseAbs().maxCoeff() > kRoundOff * size)
      return;
    throw ModelError("load " + std::to_string(i + 1) + " of " + std::to_string(count) +
                     " acts on held faces only and has no effect: move it off the supports, or "
                     "hold less");
  }
};

StaticSystem::StaticSystem(TetMesh mesh, Material material, std::vector<Support> supports,
                           StaticSettings settings, std::vector<RemoteMass> masses,
                           std::shared_ptr<const KeptElements> kept)
    : data_(std::make_unique<Data>()) {
  check_mesh(mesh);
  check_material(material);
  check_settings(settings);
  check_masses(masses);
  Data& d = *data_;
  auto held = std::make_shared<HeldPart>();
  held->mesh = std::move(mesh);
  held->material = std::move(material);
  held->supports = std::move(supports);
  held->masses = std::move(masses);
  held->settings = settings;
  held->constraints = constrain(held->mesh, held->supports);
  require_held(held->mesh, held->constraints);
  held->clamped = clamped_triangles(held->mesh, held->supports);
  held->places = body_places(held->mesh);
  d.part = held;
  d.equations = free_components(held->constraints);
  if (kept && d.equations > 0) {
    d.condensed = std::make_unique<CondensedFactor>(std::move(kept), held->mesh, held->material);
    return;
  }
  d.pattern = order_nodes(held->mesh, held->constraints);
  if (d.equations == 0) return;
  const bool direct = solves_directly(d.pattern, settings);
  require_memory(matrix_bytes(d.pattern) + (direct ? factor_bytes(d.pattern) : 0.0),
                 settings.memory_limit, static_cast<int>(held->mesh.nodes.rows()));
  LowerMatrix stiffness = assemble_stiffness(held->mesh, held->material, d.pattern);
  if (direct) {
    d.factor = std::make_unique<CholeskyFactor>(d.pattern, stiffness);
  } else {
    d.stiffness = std::move(stiffness);
    d.preconditioner =
        std::make_unique<TwoLevelPreconditioner>(held->mesh, held->material, held->constraints,
                                                 d.pattern, d.stiffness, settings.memory_limit);
  }
}

StaticSystem::~StaticSystem() = default;
StaticSystem::StaticSystem(StaticSystem&&) noexcept = default;
StaticSystem& StaticSystem::operator=(StaticSystem&&) noexcept = default;

const TetMesh& StaticSystem::mesh() const { return data_->part->mesh; }

StaticResult StaticSystem::solve(const std::vector<Load>& loads) const {
  return std::move(solve_all({loads}, {""}).front());
}

std::vector<StaticResult> StaticSystem::solve_all(const std::vector<std::vector<Load>>& cases,
                                                  const std::vector<std::string>& names) const {
  const Data& d = *data_;
  if (cases.empty()) return {};
  std::vector<Response> responses;
  for (std::size_t i = 0; i < cases.size(); ++i) try {
      responses.push_back(d.loaded(cases[i]));
    } catch (const ModelError& error) {
      if (cases.size() == 1) throw;
      throw ModelError("load case '" + names[i] + "': " + error.what());
    }
  const std::vector<Multiple> same = multiples(responses, d.part->constraints);
  std::vector<Response> solved;
  for (std::size_t i = 0; i < cases.size(); ++i)
    if (same[i].of == i) solved.push_back(std::move(responses[i]));
  std::vector<StaticResult> answers = d.answers(std::move(solved));
  std::vector<StaticResult> results(cases.size());
  for (std::size_t i = 0, next = 0; i < cases.size(); ++i)
    results[i] =
        same[i].of == i ? std::move(answers[next++]) : scaled(results[same[i].of], same[i].factor);
  return results;
}

UnitResponses StaticSystem::unit_responses(const std::vector<std::vector<Load>>& units) const {
  const Data& d = *data_;
  const HeldPart& part = *d.part;
  if (!part.constraints.displacement.isZero(0.0)) {
    throw ModelError("loads that vary need supports that are not moved");
  }
  const auto count = static_cast<Eigen::Index>(units.size());
  Eigen::MatrixXd loads(3 * part.mesh.nodes.rows(), count), displacements(loads.rows(), count);
  std::vector<Load> all;
  for (Eigen::Index i = 0; i < count; ++i) {
    const std::vector<Load>& unit = units[static_cast<std::size_t>(i)];
    loads.col(i) = load_vector(part.mesh, part.material, unit);
    all.insert(all.end(), unit.begin(), unit.end());
  }
  const std::vector<Data::Displaced> displaced = d.displace(loads, kSuperposed);
  for (Eigen::Index i = 0; i < count; ++i)
    displacements.col(i) = displaced[static_cast<std::size_t>(i)].displacement;
  return {d.part, loaded_triangles(part.mesh, all), std::move(displacements), std::move(loads)};
}

NaturalModes StaticSystem::natural_modes(int count) const {
  const Data& d = *data_;
  const HeldPart& part = *d.part;
  if (d.refactors()) {
    return codesign::fem::natural_modes(part.mesh, part.material, part.supports, count,
                                        d.memory_left(), part.masses);
  }
  if (!(part.material.density > 0)) throw std::invalid_argument("modes need a density above 0");
  const Eigen::MatrixXd carried = carried_columns(part.mesh, d.pattern, part.masses);
  if (!d.factor) {
    return modes_by_iteration(d.pattern, assemble_nodal_mass(part.mesh, part.material, d.pattern),
                              carried, d.stiffness, *d.preconditioner, 0.0, count);
  }
  return modes_of_factor(d.pattern, assemble_mass(part.mesh, part.material, d.pattern), carried,
                         *d.factor, 0.0, count);
}

Points StaticSystem::displacement(const std::vector<Load>& given) const {
  const Eigen::VectorXd u = data_->displace(data_->loaded(given).load).front().displacement;
  return Eigen::Map<const Points>(u.data(), data_->part->mesh.nodes.rows(), 3);
}

BucklingModes StaticSystem::buckling_modes(const Points& displacement, int count) const {
  const Data& d = *data_;
  if (d.refactors()) {
    return codesign::fem::buckling_modes(d.part->mesh, d.part->material, d.part->supports,
                                         displacement, count, d.memory_left());
  }
  if (!d.factor) {
    return buckling_by_iteration(d.part->mesh, d.part->material, d.pattern, d.stiffness,
                                 *d.preconditioner, displacement, count);
  }
  return buckling_of_factor(d.part->mesh, d.part->material, d.pattern, *d.factor, displacement,
                            count);
}

StaticResult solve_static(const StaticModel& model) {
  return StaticSystem(model.mesh, model.material, model.supports, model.settings)
      .solve(model.loads);
}

}  // namespace codesign::fem
