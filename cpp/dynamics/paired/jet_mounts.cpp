#include "dynamics/paired/jet_mounts.hpp"

#include <Eigen/Geometry>

namespace codesign::dynamics {

using Eigen::Matrix3d;
using Eigen::Vector3d;

std::vector<JetMount> mount_jets(const Model& model, const std::vector<Actuator>& actuators) {
  std::vector<JetMount> jets;
  for (const Actuator& actuator : actuators) {
    const Frame& frame = model.frames[static_cast<std::size_t>(frame_index(model, actuator.frame))];
    jets.push_back({frame.body, frame.body_T_frame.p, frame.body_T_frame.R * actuator.axis,
                    actuator.reaction});
  }
  return jets;
}

void push_jets(const std::vector<JetMount>& jets, const Eigen::Ref<const Eigen::VectorXd>& thrusts,
               PairedBodies& bodies) {
  for (std::size_t i = 0; i < jets.size(); ++i) {
    const JetMount& jet = jets[i];
    const Matrix3d R = bodies.rotation(jet.body);
    const Vector3d force = thrusts[static_cast<Eigen::Index>(i)] * (R * jet.axis);
    const Vector3d arm = R * jet.origin;
    bodies.push(jet.body, force, arm.cross(force) + jet.reaction * force);
  }
}

}  // namespace codesign::dynamics
