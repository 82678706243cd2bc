#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "fem/elasticity/static_solver.hpp"
#include "fem/mesh/tet_mesh.hpp"
#include "fem/stress/history_peak.hpp"
#include "fem/stress/recovery.hpp"

namespace codesign::fem {

struct HeldPart;

// The answers of a part to unit loads, solved once; any history of loads is then a sum of them.
// Holds displacement, load and stress (96 bytes a node and unit load), no factor.
class UnitResponses {
 public:
  // displacement, load: (3 n, units), of supports that are not moved. loaded: boundary triangles
  // that any of the unit loads acts on.
  UnitResponses(std::shared_ptr<const HeldPart> part, std::vector<int> loaded,
                Eigen::MatrixXd displacement, Eigen::MatrixXd load);

  Eigen::Index units() const { return displacement_.cols(); }
  const TetMesh& mesh() const;

  // (n, 6 units) recovered stress at the nodes, Pa: xx yy zz xy yz zx of the first unit load, then
  // of the next.
  const StressFields& stress() const { return stress_; }

  // The largest von Mises stress over the instants (rows) of a history of the unit loads' factors.
  // Throws ModelError if the exclusion leaves no place, std::invalid_argument for a wrong size.
  HistoryPeak peak(const LoadHistory& history) const;

  // All that one instant gives, as a solution with its loads would. factors: (units).
  StaticResult at(const Eigen::VectorXd& factors) const;

 private:
  std::shared_ptr<const HeldPart> part_;
  std::vector<int> loaded_;
  Eigen::MatrixXd displacement_, load_;
  StressFields stress_;  // (n, 6 units) at the nodes
};

}  // namespace codesign::fem
