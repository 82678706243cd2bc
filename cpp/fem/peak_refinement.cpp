#include "fem/peak_refinement.hpp"

#include <algorithm>
#include <cmath>

namespace codesign::fem {

namespace {

constexpr double kGrowth = 0.4, kRadius = 4.0;  // radius in new edge lengths
constexpr double kFineEnough = 1.0 + 1e-9;      // of the wanted edge length

}  // namespace

std::vector<std::size_t> open_cases(const std::vector<CaseConvergence>& convergence) {
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < convergence.size(); ++i)
    if (!convergence[i].settled) open.push_back(i);
  return open;
}

SizeField refine_around_peaks(const SizeField& size, const std::vector<StaticResult>& results,
                              const std::vector<std::size_t>& cases) {
  SizeField refined = size;
  for (const std::size_t i : cases) {
    const Eigen::Vector3d& peak = results[i].peak_position;
    const double edge = 0.5 * size_at(size, peak);
    if (size_at(refined, peak) <= kFineEnough * edge) continue;
    refined.sources.push_back({Points(peak.transpose()), edge, kGrowth, kRadius * edge});
  }
  return refined;
}

std::vector<CaseConvergence> judge_cases(const std::vector<StaticResult>& before,
                                         const std::vector<StaticResult>& finer,
                                         std::vector<CaseConvergence> convergence,
                                         const std::vector<std::size_t>& refined,
                                         double tolerance) {
  for (const std::size_t i : refined) convergence[i] = {true, 0.0, false};
  for (std::size_t i = 0; i < finer.size(); ++i) {
    CaseConvergence& found = convergence[i];
    const double peak = finer[i].peak_stress;
    const double change = peak > 0.0 ? std::abs(peak - before[i].peak_stress) / peak : 0.0;
    found.change = std::max(found.change, change);
    found.settled = (found.refined || peak == 0.0) &&
                    std::max(finer[i].stress_error, found.change * peak) <= tolerance * peak;
  }
  return convergence;
}

}  // namespace codesign::fem
