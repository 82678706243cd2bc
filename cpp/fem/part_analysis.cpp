#include "fem/part_analysis.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace codesign::fem {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// The lowest frequencies of the part; the modes of a symmetric part are symmetric (those of its
// half) or antisymmetric: on the cut plane the other components are then held.
Eigen::VectorXd frequencies(const PartCase& part, const StaticSystem& system) {
  Eigen::VectorXd lowest = system.natural_modes(part.modes).frequency;
  std::vector<Support> turned = part.supports;
  bool half = false;
  for (Support& support : turned) {
    if (!support.symmetry) continue;
    half = true;
    for (bool& fixed : support.fixed) fixed = !fixed;
  }
  if (!half || part.settings.copies != 2) return lowest;
  const Eigen::VectorXd others =
      natural_modes(system.mesh(), part.material, turned, part.modes).frequency;
  Eigen::VectorXd all(lowest.size() + others.size());
  all << lowest, others;
  std::sort(all.begin(), all.end());
  return all.head(std::min<Eigen::Index>(part.modes, all.size()));
}

// One mesh and its solution; times are added to those of the passes before.
void run_pass(const PartCase& part, PartAnalysis& analysis) {
  const Clock::time_point start = Clock::now();
  analysis.mesh = tetrahedralize(part.surface, analysis.size, part.mesh_options);
  analysis.mesh_seconds += seconds_since(start);
  const Clock::time_point meshed = Clock::now();
  const StaticSystem system(analysis.mesh, part.material, part.supports, part.settings);
  analysis.result = system.solve(part.loads);
  if (part.modes > 0) analysis.frequencies = frequencies(part, system);
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
  PartAnalysis analysis;
  analysis.size = part.size;
  run_pass(part, analysis);
  const auto within = [&](const PartAnalysis& a) {
    return std::max(a.result.stress_error, a.change * a.result.peak_stress) <=
           part.tolerance * a.result.peak_stress;
  };
  analysis.converged = within(analysis);
  while (analysis.refinements < part.max_refinements &&
         !(analysis.converged && analysis.refinements > 0)) {
    PartAnalysis finer;
    finer.size = refine_around(analysis.size, analysis.result.peak_position);
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
    const double peak = finer.result.peak_stress;
    finer.change = peak > 0 ? std::abs(peak - analysis.result.peak_stress) / peak : 0.0;
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
