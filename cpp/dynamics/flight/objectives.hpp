#pragma once

#include "dynamics/flight/flight_log.hpp"
#include "dynamics/flight_settings.hpp"

namespace codesign::dynamics {

// Largest singular value.
double spectral_norm(const Eigen::Ref<const Eigen::MatrixXd>& X);

// The series (N, n), written out sample after sample and cut into n columns of length N again: the
// authors' program reshapes it so. Keeps the Frobenius norm, not the singular values.
Eigen::MatrixXd reshaped_series(const History& series);

// Fills the objective families and their parts from the histories.
void compute_objectives(const FlightSettings& settings, FlightLog& log);

}  // namespace codesign::dynamics
