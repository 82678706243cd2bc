#pragma once

#include <cstddef>
#include <vector>

#include "fem/elasticity/static_solver.hpp"
#include "fem/meshing/size_field.hpp"

namespace codesign::fem {

// How far the peak stress of a load case is settled by meshes refined around it.
struct CaseConvergence {
  bool refined = false;  // there, at least once
  double change = 0.0;   // of the peak by the last refinement there, relative; the largest since
  bool settled = false;  // refined, estimated error and change within the tolerance; or no stress
};

// Load cases that are not settled.
std::vector<std::size_t> open_cases(const std::vector<CaseConvergence>& convergence);

// The size field with half the edge length around the peaks of these load cases; peaks that lie
// together are refined once.
SizeField refine_around_peaks(const SizeField& size, const std::vector<StaticResult>& results,
                              const std::vector<std::size_t>& cases);

// What the results of a finer mesh, refined around the peaks of the cases `refined`, say beside
// those before. tolerance: relative, of the peak stress.
std::vector<CaseConvergence> judge_cases(const std::vector<StaticResult>& before,
                                         const std::vector<StaticResult>& finer,
                                         std::vector<CaseConvergence> convergence,
                                         const std::vector<std::size_t>& refined, double tolerance);

}  // namespace codesign::fem
