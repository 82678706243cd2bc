#include "bindings/evaluate.hpp"

#include <chrono>

#include "dynamics/flight/flight.hpp"
#include "dynamics/urdf/urdf.hpp"

namespace codesign {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

DesignResult evaluate(const std::vector<fem::PartCase>& parts, const std::string& urdf,
                      const dynamics::FlightSettings& flight,
                      const std::vector<std::uint64_t>& seeds) {
  DesignResult result;
  Clock::time_point start = Clock::now();
  for (const fem::PartCase& part : parts) result.parts.push_back(fem::analyze_part(part));
  result.fem_seconds = seconds_since(start);
  start = Clock::now();
  dynamics::UrdfOptions options;
  options.joints = flight.joints;
  const dynamics::Model model = dynamics::load_urdf(urdf, options);
  result.flights = dynamics::simulate_flights(model, flight, seeds);
  result.flight_seconds = seconds_since(start);
  return result;
}

}  // namespace codesign
