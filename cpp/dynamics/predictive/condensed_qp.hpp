#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/predictive/prediction_grid.hpp"
#include "dynamics/predictive/prediction_model.hpp"

namespace codesign::dynamics {

// What the prediction is to follow at the end of one of its steps.
struct PredictionReference {
  Eigen::Vector3d com = Eigen::Vector3d::Zero();               // [m]
  Eigen::Vector3d linear_momentum = Eigen::Vector3d::Zero();   // body axes [kg m/s]
  Eigen::Vector3d rpy = Eigen::Vector3d::Zero();               // [rad]
  Eigen::Vector3d angular_momentum = Eigen::Vector3d::Zero();  // body axes [kg m²/s]
};

// What one solve is given besides the model of the prediction.
struct PredictionTask {
  explicit PredictionTask(int steps, int joints, int jets);
  PredictionState state;                        // measured
  PredictionReference now;                      // at the solve; integrals grow with errors from it
  std::vector<PredictionReference> references;  // at the end of each step
  Eigen::VectorXd posture_error;                // (joints) set point less its home [rad]
  Eigen::VectorXd variable;                     // (jets) throttle variable that acts
};

// The prediction condensed to its inputs:  minimize ½ xᵀHx + gᵀx.
//
// All states are affine in the unknowns x. They are marched through the grid as arrays with one row
// for the value at x = 0 (less its reference, once weighted) and one for the derivative by each
// unknown; the Gram matrix of the weighted arrays then holds gradient and Hessian at once.
class CondensedQp {
 public:
  CondensedQp(const PredictiveSettings& settings, int joints, int jets);

  const PredictionGrid& grid() const { return grid_; }
  int size() const { return grid_.unknowns; }

  void build(const PredictionModel& model, const PredictionTask& task);

  // Valid until the next build.
  auto hessian() const { return gram_.bottomRightCorner(size(), size()); }  // both triangles
  auto gradient() const { return gram_.col(0).tail(size()); }

 private:
  using Rows = Eigen::Index;
  using Columns3 = Eigen::Matrix<double, Eigen::Dynamic, 3>;

  void start(const PredictionTask& task);
  void advance(const PredictionModel& model, const PredictionTask& task,
               const PredictionGrid::Step& step);
  void add_forces(const PredictionModel& model, const PredictionGrid::Step& step, Rows rows);
  void advance_jets(const PredictionModel& model, const PredictionGrid::Step& step, Rows rows);
  void add_cost(const PredictionReference& reference, Rows rows);
  void add_input_cost(const PredictionTask& task);

  PredictiveWeights weights_;
  bool jet_dynamics_;
  PredictionGrid grid_;
  int joints_, jets_;
  // Row 0: value at x = 0; row 1 + i: derivative by unknown i.
  Columns3 com_, linear_, rpy_, angular_, com_integral_, rpy_integral_, change_;
  Eigen::MatrixXd thrust_, thrust_rate_, thrust_next_;
  Eigen::MatrixXd weighted_;  // (1 + unknowns, 18)
  Eigen::MatrixXd gram_;
};

}  // namespace codesign::dynamics
