#pragma once

#include <algorithm>
#include <ctime>
#include <fstream>
#include <stdexcept>

#include "fem/boundary/supports.hpp"
#include "fem/mesh/tet_mesh.hpp"

// What the benchmarks of solvers share: models that benchmarks/symbolic_factor.py writes, CPU time.
namespace codesign::fem {

inline double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template <typename Action>
auto timed(double& least, Action action) {
  const double start = cpu_seconds();
  auto result = action();
  least = std::min(least, cpu_seconds() - start);
  return result;
}

struct Model {
  TetMesh mesh;
  Constraints constraints;
};

inline Model read_model(const char* path) {
  std::ifstream file(path);
  Eigen::Index nodes = 0, tets = 0;
  file >> nodes >> tets;
  Model model;
  model.mesh.nodes.resize(nodes, 3);
  model.mesh.tets.resize(tets, 10);
  for (double& x : model.mesh.nodes.reshaped<Eigen::RowMajor>()) file >> x;
  for (int& node : model.mesh.tets.reshaped<Eigen::RowMajor>()) file >> node;
  model.constraints.fixed.resize(static_cast<std::size_t>(3 * nodes));
  for (char& fixed : model.constraints.fixed) {
    int value = 0;
    file >> value;
    fixed = static_cast<char>(value);
  }
  if (!file) throw std::runtime_error("not a model");
  return model;
}

}  // namespace codesign::fem
