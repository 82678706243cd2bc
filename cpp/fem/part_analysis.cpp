#include "fem/part_analysis.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "model_error.hpp"

namespace codesign::fem {

namespace {

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

// The lowest frequencies of the part; the modes of a symmetric part are symmetric (those of its
// half) or antisymmetric.
Eigen::VectorXd frequencies(const PartCase& part, const StaticSystem& system) {
  const Eigen::VectorXd symmetric = system.natural_modes(part.modes).frequency;
  const std::vector<Support> turned = antisymmetric_supports(part);
  if (turned.empty()) return symmetric;
  const NaturalModes others = natural_modes(system.mesh(), part.material, turned, part.modes);
  return lowest_of(symmetric, others.frequency, part.modes);
}

// The lowest buckling factors of the part, symmetric and antisymmetric modes alike: the load and
// so the stress are symmetric in both.
Eigen::VectorXd buckling_factors(const PartCase& part, const StaticSystem& system,
                                 const Points& displacement) {
  Eigen::VectorXd found = system.buckling_modes(displacement, part.buckling).factor;
  const std::vector<Support> turned = antisymmetric_supports(part);
  if (!turned.empty()) {
    const BucklingModes others =
        buckling_modes(system.mesh(), part.material, turned, displacement, part.buckling);
    found = lowest_of(found, others.factor, part.buckling);
  }
  Eigen::VectorXd factors =
      Eigen::VectorXd::Constant(part.buckling, std::numeric_limits<double>::infinity());
  factors.head(found.size()) = found;
  return factors;
}

// Every load case by one factor, and which of them governs: the first where several are equal.
void solve_cases(const PartCase& part, const StaticSystem& system, PartAnalysis& analysis) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < part.cases.size(); ++i) {
    const LoadCase& load_case = part.cases[i];
    try {
      analysis.results.push_back(system.solve(load_case.loads));
    } catch (const ModelError& error) {
      if (part.cases.size() == 1) throw;
      throw ModelError("load case '" + load_case.name + "': " + error.what());
    }
    analysis.case_names.push_back(load_case.name);
    const double reserve = analysis.results[i].safety_factor / load_case.least_safety_factor;
    if (reserve < least) {
      least = reserve;
      analysis.governing = i;
    }
  }
}

// One mesh and its solution; times are added to those of the passes before.
void run_pass(const PartCase& part, PartAnalysis& analysis) {
  const Clock::time_point start = Clock::now();
  MeshOptions options = part.mesh_options;
  options.measure_distance = false;  // nobody reads it here
  analysis.mesh = tetrahedralize(part.surface, analysis.size, options);
  analysis.mesh_seconds += seconds_since(start);
  const Clock::time_point meshed = Clock::now();
  const StaticSystem system(analysis.mesh, part.material, part.supports, part.settings);
  solve_cases(part, system, analysis);
  if (part.modes > 0) analysis.frequencies = frequencies(part, system);
  for (std::size_t i = 0; part.buckling > 0 && i < analysis.results.size(); ++i) {
    Eigen::VectorXd factors = buckling_factors(part, system, analysis.results[i].displacement);
    if (i == 0 || factors[0] < analysis.buckling_factors[0]) {
      analysis.buckling_factors = std::move(factors);
    }
  }
  analysis.solve_seconds += seconds_since(meshed);
}

}  // namespace

SizeField refine_around(const SizeField& size, const Eigen::Vector3d& point) {
  constexpr double kGrowth = 0.4, kRadius = 4.0;  // radius in new edge lengths
  const double edge = 0.5 * size_at(size, point);
  SizeField refined = size;
  refined.sources.push_back({Points(point.transpose()), edge, kGrowth, kRadius * edge});
  return refined;
}

PartAnalysis analyse_part(const PartCase& part) {
  if (!(part.tolerance > 0)) throw std::invalid_argument("tolerance must be > 0");
  if (part.cases.empty()) throw std::invalid_argument("cases: a part needs a load case");
  for (const LoadCase& load_case : part.cases) {
    if (!(load_case.least_safety_factor > 0)) {
      throw std::invalid_argument("least_safety_factor must be > 0");
    }
  }
  PartAnalysis analysis;
  analysis.size = part.size;
  run_pass(part, analysis);
  const auto within = [&](const PartAnalysis& a) {
    return std::max(a.result().stress_error, a.change * a.result().peak_stress) <=
           part.tolerance * a.result().peak_stress;
  };
  analysis.converged = within(analysis);
  while (analysis.refinements < part.max_refinements &&
         !(analysis.converged && analysis.refinements > 0)) {
    PartAnalysis finer;
    finer.size = refine_around(analysis.size, analysis.result().peak_position);
    finer.refinements = analysis.refinements + 1;
    finer.mesh_seconds = analysis.mesh_seconds;
    finer.solve_seconds = analysis.solve_seconds;
    try {
      run_pass(part, finer);
    } catch (const std::runtime_error& error) {  // MeshError or SolverError: too many elements, say
      analysis.converged = false;
      analysis.stopped = error.what();
      return analysis;
    }
    const double peak = finer.result().peak_stress;
    finer.change = peak > 0 ? std::abs(peak - analysis.result().peak_stress) / peak : 0.0;
    finer.converged = within(finer);
    analysis = std::move(finer);
  }
  if (!analysis.converged) {
    analysis.stopped = "the estimated error is above the tolerance after " +
                       std::to_string(analysis.refinements) + " refinements";
  }
  return analysis;
}

}  // namespace codesign::fem
