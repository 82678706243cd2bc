#pragma once

#include <Eigen/Core>
#include <string>

namespace codesign::fem {

// Linear elastic, isotropic.
struct Material {
  std::string name;
  double young_modulus = 0.0;   // Pa
  double poisson_ratio = 0.0;   // -1 < nu < 1/2
  double density = 0.0;         // kg/m³
  double yield_strength = 0.0;  // Pa
};

// Throws std::invalid_argument naming the value that is out of range.
void check_material(const Material& material);

// Stress and strain as vectors xx yy zz xy yz zx; shear strains are engineering ones (gamma).
using Voigt = Eigen::Matrix<double, 6, 1>;

// Elastic constants.
double lame_lambda(const Material& material);    // Pa
double shear_modulus(const Material& material);  // Pa

// Stress of a strain, Pa.
Voigt stress_of_strain(double lambda, double mu, const Voigt& strain);

// Stress of a displacement gradient, entry (i, j) = d u_i / d x_j, Pa.
Voigt stress_of_gradient(double lambda, double mu, const Eigen::Matrix3d& gradient);

// Von Mises stress of a stress, Pa.
double von_mises(const Voigt& stress);

}  // namespace codesign::fem
