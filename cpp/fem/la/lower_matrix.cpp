#include "fem/la/lower_matrix.hpp"

#include <cstddef>

namespace codesign::fem {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

Eigen::VectorXd multiply(const LowerMatrix& a, const Eigen::VectorXd& x) {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(x.size());
  for (int j = 0; j < a.size(); ++j) {
    int p = a.start[at(j)];
    double sum = a.value[at(p)] * x[j];
    for (++p; p < a.start[at(j) + 1]; ++p) {
      const int i = a.row[at(p)];
      y[i] += a.value[at(p)] * x[j];
      sum += a.value[at(p)] * x[i];
    }
    y[j] += sum;
  }
  return y;
}

}  // namespace codesign::fem
