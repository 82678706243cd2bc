#include "fem/part_analysis.hpp"

#include <chrono>
#include <utility>

namespace codesign::fem {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

PartAnalysis analyse_part(const PartCase& part) {
  PartAnalysis analysis;
  const Clock::time_point start = Clock::now();
  analysis.mesh = tetrahedralize(part.surface, part.size, part.mesh_options);
  analysis.mesh_seconds = seconds_since(start);
  const Clock::time_point meshed = Clock::now();
  const StaticSystem system(analysis.mesh, part.material, part.supports, part.settings);
  analysis.result = system.solve(part.loads);
  analysis.solve_seconds = seconds_since(meshed);
  return analysis;
}

}  // namespace codesign::fem
