#include "fem/elasticity/unit_responses.hpp"

#include <stdexcept>
#include <string>
#include <utility>

#include "fem/elasticity/held_part.hpp"
#include "fem/elasticity/stiffness.hpp"
#include "fem/stress/corner_stress.hpp"
#include "fem/stress/stress.hpp"

namespace codesign::fem {

namespace {

StressFields recovered(const HeldPart& part, const Eigen::MatrixXd& displacement) {
  StressFields points(4 * part.mesh.tets.rows(), 6 * displacement.cols());
  for (Eigen::Index u = 0; u < displacement.cols(); ++u) {
    points.middleCols<6>(6 * u) =
        point_stresses(part.mesh, part.material, displacement.col(u)).stress;
  }
  StressFields nodal = recover_fields(part.mesh, part.places, points);
  for (Eigen::Index u = 0; u < displacement.cols(); ++u) {
    const CornerStress corners =
        corner_stress(part.mesh, part.places, part.material, displacement.col(u));
    nodal(corners.nodes, Eigen::seqN(6 * u, 6)) = corners.stress;
  }
  return nodal;
}

}  // namespace

UnitResponses::UnitResponses(std::shared_ptr<const HeldPart> part, std::vector<int> loaded,
                             Eigen::MatrixXd displacement, Eigen::MatrixXd load)
    : part_(std::move(part)),
      loaded_(std::move(loaded)),
      displacement_(std::move(displacement)),
      load_(std::move(load)),
      stress_(recovered(*part_, displacement_)) {}

const TetMesh& UnitResponses::mesh() const { return part_->mesh; }

HistoryPeak UnitResponses::peak(const LoadHistory& history) const {
  const bool inside = part_->settings.exclusion != ExclusionRule::published;
  return history_peak(part_->mesh, stress_, history, exclusion_zone(*part_, loaded_), inside);
}

StaticResult UnitResponses::at(const Eigen::VectorXd& factors) const {
  if (factors.size() != units()) {
    throw std::invalid_argument("one instant needs " + std::to_string(units()) + " factors");
  }
  const Eigen::VectorXd u = displacement_ * factors;
  const Eigen::VectorXd internal = internal_forces(part_->mesh, part_->material, u).sum;
  return std::move(read_results(*part_, {{loaded_, load_ * factors, internal, u}}).front());
}

}  // namespace codesign::fem
