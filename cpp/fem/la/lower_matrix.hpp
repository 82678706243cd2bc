#pragma once

#include <Eigen/Core>
#include <vector>

namespace codesign::fem {

// Lower triangle of a symmetric matrix in compressed columns, rows ascending.
struct LowerMatrix {
  std::vector<int> start, row;
  std::vector<double> value;

  int size() const { return static_cast<int>(start.size()) - 1; }
};

// y = A x
Eigen::VectorXd multiply(const LowerMatrix& a, const Eigen::VectorXd& x);

}  // namespace codesign::fem
