#pragma once

#include <string>
#include <vector>

#include "dynamics/flight/flight_log.hpp"
#include "dynamics/flight_settings.hpp"
#include "fem/part_analysis.hpp"

namespace codesign {

struct DesignResult {
  std::vector<fem::PartAnalysis> parts;      // in the order of the cases
  std::vector<dynamics::FlightLog> flights;  // one per seed
  double fem_seconds = 0.0;                  // wall clock
  double flight_seconds = 0.0;               // wall clock, loading the robot included
};

// The native half of the chain in one call: meshes and solves every part, loads the robot, flies
// it once for every seed of the disturbances. The parts of a design that is cached are left out of
// `parts`. Throws MeshError, SolverError, UrdfError; std::invalid_argument where inputs do not fit
// together.
DesignResult evaluate(const std::vector<fem::PartCase>& parts, const std::string& urdf,
                      const dynamics::FlightSettings& flight,
                      const std::vector<std::uint64_t>& seeds);

}  // namespace codesign
