#include "fem/part_analysis.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <new>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "errors.hpp"
#include "fem/kept_meshes.hpp"
#include "fem/meshing/mesh_watch.hpp"

namespace codesign::fem {

namespace {

// Load cases and designs that a kept factor serves, at least: it may take so much longer than one
// that serves a single solution.
constexpr double kDesignsServed = 8.0;
// Corner nodes that an analysis by iteration can afford: measured on tubes and plates of 2 to 4
// elements across the wall (benchmarks/robustness/limits.py).
constexpr double kBytesPerVertex = 2.2e4;

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Supports of the half of a symmetric part for its antisymmetric motions: on the cut plane the
// other components are then held. Empty if the model is no half.
std::vector<Support> antisymmetric_supports(const PartCase& part) {
  std::vector<Support> turned = part.supports;
  bool half = false;
  for (Support& support : turned) {
    if (!support.symmetry) continue;
    half = true;
    for (bool& fixed : support.fixed) fixed = !fixed;
  }
  if (!half || part.settings.copies != 2) turned.clear();
  return turned;
}

// The lowest `count` of two sets of eigenvalues, ascending.
Eigen::VectorXd lowest_of(const Eigen::VectorXd& some, const Eigen::VectorXd& others, int count) {
  Eigen::VectorXd all(some.size() + others.size());
  all << some, others;
  std::sort(all.begin(), all.end());
  return all.head(std::min<Eigen::Index>(count, all.size()));
}

// The mesher's options for a pass: the time that the passes before have left, and no more vertices
// than could be solved within the memory limit.
MeshOptions pass_options(const PartCase& part, double seconds) {
  MeshOptions options = part.mesh_options;
  options.measure_distance = false;  // nobody reads it here
  options.time_limit = std::max(options.time_limit - seconds, 1e-3);
  const double most = part.settings.memory_limit / kBytesPerVertex;
  if (most < static_cast<double>(options.max_vertices))
    options.max_vertices = static_cast<std::size_t>(most);
  return options;
}

[[noreturn]] void out_of_memory(const PartAnalysis& analysis) {
  const auto nodes = analysis.mesh.nodes.rows();
  std::ostringstream text;
  text << "the process has no memory left ";
  if (nodes > 0) text << "for the analysis of a mesh of " << nodes << " nodes";
  if (nodes == 0) text << "for a mesh of the edge length " << analysis.size.base * 1e3 << " mm";
  text << ": larger elements or a larger memory limit (execution.memory_limit_mib of a study) are "
          "needed";
  throw MemoryLimitError(text.str());
}

bool any_antisymmetric(const PartCase& part) {
  return std::any_of(part.cases.begin(), part.cases.end(),
                     [](const LoadCase& load_case) { return load_case.antisymmetric; });
}

// Whether anything asks for the symmetric motions, which are all there are of a whole part.
bool any_symmetric(const PartCase& part) {
  return !part.varying.empty() || part.modes > 0 || part.buckling > 0 ||
         std::any_of(part.cases.begin(), part.cases.end(),
                     [](const LoadCase& load_case) { return !load_case.antisymmetric; });
}

// The load cases of one kind, by the factor of a system that moves as they do.
void solve_cases(const PartCase& part, const StaticSystem& system, bool antisymmetric,
                 PartAnalysis& analysis) {
  std::vector<std::size_t> chosen;
  std::vector<std::vector<Load>> loads;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < part.cases.size(); ++i) {
    if (part.cases[i].antisymmetric != antisymmetric) continue;
    chosen.push_back(i);
    loads.push_back(part.cases[i].loads);
    names.push_back(part.cases[i].name);
  }
  if (chosen.empty()) return;
  std::vector<StaticResult> results = system.solve_all(loads, names);
  for (std::size_t i = 0; i < chosen.size(); ++i)
    analysis.results[chosen[i]] = std::move(results[i]);
}

// Which of the cases governs: the first where several are equal.
void find_governing(const PartCase& part, PartAnalysis& analysis) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < part.cases.size(); ++i) {
    const double reserve = analysis.results[i].safety_factor / part.cases[i].least_safety_factor;
    if (reserve < least) {
      least = reserve;
      analysis.governing = i;
    }
  }
}

// The lowest buckling factors of each load case, `count` a case, infinity where there are fewer; of
// the symmetric motions, then those of the antisymmetric ones among them: load and so stress are
// symmetric in both.
using CaseFactors = std::vector<Eigen::VectorXd>;

CaseFactors buckling_factors(const PartCase& part, const StaticSystem& system,
                             const PartAnalysis& analysis) {
  CaseFactors factors;
  for (const StaticResult& result : analysis.results)
    factors.push_back(system.buckling_modes(result.displacement, part.buckling).factor);
  return factors;
}

void add_antisymmetric_factors(const PartCase& part, const std::vector<Support>& turned,
                               const PartAnalysis& analysis, CaseFactors& factors) {
  for (std::size_t i = 0; i < factors.size(); ++i) {
    const BucklingModes others =
        buckling_modes(analysis.mesh, part.material, turned, analysis.results[i].displacement,
                       part.buckling, part.settings.memory_limit);
    factors[i] = lowest_of(factors[i], others.factor, part.buckling);
  }
}

// Those of the case that buckles first.
Eigen::VectorXd least_factors(const CaseFactors& factors, int count) {
  Eigen::VectorXd least;
  for (const Eigen::VectorXd& found : factors) {
    Eigen::VectorXd filled =
        Eigen::VectorXd::Constant(count, std::numeric_limits<double>::infinity());
    filled.head(found.size()) = found;
    if (least.size() == 0 || filled[0] < least[0]) least = std::move(filled);
  }
  return least;
}

// Load cases that one factor serves; of a part without varying ones as if there were one, so that
// its solver does not depend on their number.
int solutions(const PartCase& part) {
  std::size_t count = part.varying.empty() ? 1 : part.cases.size();
  for (const VaryingCase& varying : part.varying) count += varying.units.size();
  return static_cast<int>(count);
}

StaticSettings settings_of(const PartCase& part) {
  StaticSettings settings = part.settings;
  settings.solutions = solutions(part);
  return settings;
}

// What stretching leaves of a mesh for the symmetric, or all, and the antisymmetric load cases;
// nothing where it is not worth keeping or not needed.
struct KeptParts {
  std::shared_ptr<const KeptElements> symmetric, antisymmetric;
};

KeptParts elements_of(const PartCase& part, const std::shared_ptr<const TetMesh>& mesh) {
  FactorLimits limits = factor_limits(settings_of(part));
  limits.operations *= kDesignsServed;
  const auto keep = [&](const std::vector<Support>& supports) {
    return kept_elements(mesh, *part.stretch, part.material, constrain(*mesh, supports), limits);
  };
  KeptParts kept;
  if (any_symmetric(part)) kept.symmetric = keep(part.supports);
  if (any_antisymmetric(part)) kept.antisymmetric = keep(antisymmetric_supports(part));
  return kept;
}

// The factor of the symmetric motions gives way to that of the antisymmetric ones.
void solve(const PartCase& part, const KeptParts& kept, PartAnalysis& analysis) {
  CaseFactors factors;
  analysis.results.resize(part.cases.size());
  if (any_symmetric(part)) {
    const StaticSystem system(analysis.mesh, part.material, part.supports, settings_of(part),
                              part.masses, kept.symmetric);
    solve_cases(part, system, false, analysis);
    for (const VaryingCase& varying : part.varying) {
      analysis.responses.push_back(system.unit_responses(varying.units));
    }
    if (part.modes > 0) analysis.frequencies = system.natural_modes(part.modes).frequency;
    if (part.buckling > 0) factors = buckling_factors(part, system, analysis);
  }
  const std::vector<Support> turned = antisymmetric_supports(part);
  if (any_antisymmetric(part)) {
    const StaticSystem system(analysis.mesh, part.material, turned, settings_of(part), part.masses,
                              kept.antisymmetric);
    solve_cases(part, system, true, analysis);
  }
  find_governing(part, analysis);
  if (!turned.empty() && part.modes > 0) {
    const NaturalModes others =
        natural_modes(analysis.mesh, part.material, turned, part.modes, part.settings.memory_limit);
    analysis.frequencies = lowest_of(analysis.frequencies, others.frequency, part.modes);
  }
  if (!turned.empty()) add_antisymmetric_factors(part, turned, analysis, factors);
  if (part.buckling > 0) analysis.buckling_factors = least_factors(factors, part.buckling);
}

// A part that single precision does not resolve, kept elements or the rest of it, has one factor.
void solve_stretched(const PartCase& part, const std::shared_ptr<const TetMesh>& mesh,
                     PartAnalysis& analysis) {
  try {
    return solve(part, elements_of(part, mesh), analysis);
  } catch (const MemoryLimitError&) {
    throw;
  } catch (const SolverError&) {
    analysis.responses.clear();
  }
  solve(part, {}, analysis);
}

// Adds the processor time until it ends, whether the mesh is made or not.
struct MesherTime {
  double& seconds;
  const double start = thread_seconds();
  explicit MesherTime(double& total) : seconds(total) {}
  MesherTime(const MesherTime&) = delete;
  MesherTime& operator=(const MesherTime&) = delete;
  ~MesherTime() { seconds += thread_seconds() - start; }
};

// The mesh of a pass; returned is what stretched parts share of it, if the part is one.
std::shared_ptr<const TetMesh> make_mesh(const PartCase& part, double& mesher_seconds,
                                         PartAnalysis& analysis) {
  const MeshOptions options = pass_options(part, mesher_seconds);
  const MesherTime timed(mesher_seconds);
  std::shared_ptr<const TetMesh> kept;
  try {
    if (part.stretch) {
      kept = kept_mesh(part.surface, analysis.size, options);
      analysis.mesh = stretched(*kept, *part.stretch);
    } else {
      analysis.mesh = tetrahedralize(part.surface, analysis.size, options);
    }
  } catch (const MeshLimitError& error) {
    if (options.max_vertices == part.mesh_options.max_vertices) throw;
    throw MeshLimitError(std::string(error.what()) +
                         " (max_vertices is what can be solved within " +
                         "the memory limit, fem.memory_limit_mib of a study)");
  }
  return kept;
}

// One mesh and its solution; times are added to those of the passes before.
void try_pass(const PartCase& part, double& mesher_seconds, PartAnalysis& analysis) {
  const Clock::time_point start = Clock::now();
  const std::shared_ptr<const TetMesh> kept = make_mesh(part, mesher_seconds, analysis);
  analysis.mesh_seconds += seconds_since(start);
  const Clock::time_point meshed = Clock::now();
  kept ? solve_stretched(part, kept, analysis) : solve(part, {}, analysis);
  analysis.solve_seconds += seconds_since(meshed);
}

// Where memory runs out, what other parts have left goes, and the pass is tried once more.
void run_pass(const PartCase& part, double& mesher_seconds, PartAnalysis& analysis) try {
  try {
    return try_pass(part, mesher_seconds, analysis);
  } catch (const std::bad_alloc&) {
    if (!forget_meshes()) throw;
  } catch (const MemoryLimitError&) {
    if (!forget_meshes()) throw;
  }
  try_pass(part, mesher_seconds, analysis);
} catch (const std::bad_alloc&) {
  out_of_memory(analysis);
}

// What the half of a symmetric part can stand for.
void check_half(const PartCase& part) {
  const bool half = !antisymmetric_supports(part).empty();
  if (part.settings.copies > 1 && !part.masses.empty() && part.modes > 0)
    throw std::invalid_argument("modes: of a part with masses they are of the whole part");
  if (!any_antisymmetric(part)) return;
  if (!half) throw std::invalid_argument("antisymmetric: there is no half model");
  if (part.buckling > 0)
    throw std::invalid_argument("buckling: of an antisymmetric load it is of the whole part");
}

void check_part(const PartCase& part) {
  if (!(part.tolerance > 0)) throw std::invalid_argument("tolerance must be > 0");
  if (part.cases.empty()) throw std::invalid_argument("cases: a part needs a load case");
  for (const LoadCase& load_case : part.cases) {
    if (!(load_case.least_safety_factor > 0)) {
      throw std::invalid_argument("least_safety_factor must be > 0");
    }
  }
  check_half(part);
  if (part.stretch && part.max_refinements > 0)
    throw std::invalid_argument("stretch: a refined mesh is made of the part's own surface");
}

// Which load cases are not settled, and why there are no more refinements.
std::string unsettled(const PartAnalysis& analysis) {
  std::string names;
  for (std::size_t i = 0; i < analysis.convergence.size(); ++i) {
    if (analysis.convergence[i].settled) continue;
    names += (names.empty() ? "load case " : ", ") + analysis.case_names[i];
  }
  return names + (names.empty() ? "" : ": ") + "the estimated error" +
         (names.empty() ? "" : " or the change") + " is above the tolerance after " +
         std::to_string(analysis.refinements) + " refinements";
}

// One more pass, refined around the peaks of these load cases; what was there stands if it fails.
bool refine_once(const PartCase& part, const std::vector<std::size_t>& cases,
                 double& mesher_seconds, PartAnalysis& analysis) {
  PartAnalysis finer;
  finer.case_names = analysis.case_names;
  finer.size = refine_around_peaks(analysis.size, analysis.results, cases);
  finer.refinements = analysis.refinements + 1;
  finer.mesh_seconds = analysis.mesh_seconds;
  finer.solve_seconds = analysis.solve_seconds;
  finer.failure = analysis.failure;
  try {
    run_pass(part, mesher_seconds, finer);
  } catch (const std::runtime_error& error) {  // MeshError or SolverError: too many elements, say
    analysis.failure = error.what();
    return false;
  }
  finer.convergence = judge_cases(analysis.results, finer.results, std::move(analysis.convergence),
                                  cases, part.tolerance);
  analysis = std::move(finer);
  return true;
}

// Until every load case is settled. Where a mesh for all of them is too much, for the governing
// one.
void refine(const PartCase& part, double& mesher_seconds, PartAnalysis& analysis) {
  for (const StaticResult& result : analysis.results)
    analysis.convergence.push_back({false, 0.0, result.peak_stress == 0.0});
  bool together = true;
  while (analysis.refinements < part.max_refinements) {
    std::vector<std::size_t> open = open_cases(analysis.convergence);
    if (!together) {
      const bool governing = std::count(open.begin(), open.end(), analysis.governing) > 0;
      open.assign(governing ? 1 : 0, analysis.governing);
    }
    if (open.empty()) break;
    if (refine_once(part, open, mesher_seconds, analysis)) continue;
    if (open.size() == 1) break;
    together = false;
  }
  analysis.converged = std::all_of(analysis.convergence.begin(), analysis.convergence.end(),
                                   [](const CaseConvergence& found) { return found.settled; });
}

}  // namespace

PartAnalysis analyze_part(const PartCase& part) {
  check_part(part);
  PartAnalysis analysis;
  for (const LoadCase& load_case : part.cases) analysis.case_names.push_back(load_case.name);
  analysis.size = part.size;
  double mesher_seconds = 0.0;  // of the processor, all passes
  run_pass(part, mesher_seconds, analysis);
  const StaticResult& result = analysis.result();
  analysis.converged = result.stress_error <= part.tolerance * result.peak_stress;
  if (part.max_refinements > 0) refine(part, mesher_seconds, analysis);
  if (!analysis.converged)
    analysis.stopped = analysis.failure.empty() ? unsettled(analysis) : analysis.failure;
  return analysis;
}

}  // namespace codesign::fem
