#include "fem/mesh/material.hpp"

#include <cmath>
#include <stdexcept>

namespace codesign::fem {

namespace {

void require(bool condition, const Material& m, const char* what, double value) {
  if (condition) return;
  throw std::invalid_argument("material '" + m.name + "': " + what + ", got " +
                              std::to_string(value));
}

}  // namespace

void check_material(const Material& m) {
  require(std::isfinite(m.young_modulus) && m.young_modulus > 0, m, "young_modulus must be > 0 Pa",
          m.young_modulus);
  require(m.poisson_ratio > -1.0 && m.poisson_ratio < 0.5, m, "poisson_ratio must be in (-1, 0.5)",
          m.poisson_ratio);
  require(std::isfinite(m.density) && m.density >= 0, m, "density must be >= 0 kg/m3", m.density);
  require(std::isfinite(m.yield_strength) && m.yield_strength >= 0, m,
          "yield_strength must be >= 0 Pa", m.yield_strength);
}

double lame_lambda(const Material& m) {
  return m.young_modulus * m.poisson_ratio / ((1 + m.poisson_ratio) * (1 - 2 * m.poisson_ratio));
}

double shear_modulus(const Material& m) { return m.young_modulus / (2 * (1 + m.poisson_ratio)); }

Voigt stress_of_strain(double lambda, double mu, const Voigt& strain) {
  const double pressure = lambda * (strain[0] + strain[1] + strain[2]);
  Voigt s;
  s << pressure + 2 * mu * strain[0], pressure + 2 * mu * strain[1], pressure + 2 * mu * strain[2],
      mu * strain[3], mu * strain[4], mu * strain[5];
  return s;
}

Voigt stress_of_gradient(double lambda, double mu, const Eigen::Matrix3d& h) {
  Voigt strain;
  strain << h(0, 0), h(1, 1), h(2, 2), h(0, 1) + h(1, 0), h(1, 2) + h(2, 1), h(2, 0) + h(0, 2);
  return stress_of_strain(lambda, mu, strain);
}

double von_mises(const Voigt& s) {
  const double a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];
  return std::sqrt(0.5 * (a * a + b * b + c * c) + 3.0 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

}  // namespace codesign::fem
