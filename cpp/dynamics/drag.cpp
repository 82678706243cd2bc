#include "dynamics/drag.hpp"

#include <Eigen/Geometry>

namespace codesign::dynamics {

using Eigen::Vector3d;

Drag::Drag(const Model& model, const FlightSettings& settings)
    : wind_(settings.disturbances.wind_velocity) {
  for (const DragArea& area : settings.drag) {
    const int index = frame_index(model, area.frame);
    const Frame& frame = model.frames[static_cast<std::size_t>(index)];
    areas_.push_back({frame.body, frame.body_T_frame.p + frame.body_T_frame.R * area.position,
                      0.5 * settings.air_density * area.area});
  }
}

void Drag::add_forces(const Model& model, const RobotTerms& terms,
                      Eigen::Ref<Eigen::VectorXd> generalized) const {
  for (const Area& area : areas_) {
    const auto index = static_cast<std::size_t>(area.body);
    const BodyPose& pose = terms.kin.bodies[index];
    const BodyTwist velocity = body_twist(terms, area.body);
    const Vector3d arm = pose.R * area.position;
    add_point_force(model, terms.kin, area.body, pose.p + arm,
                    force(area, velocity.linear + velocity.angular.cross(arm)), generalized);
  }
}

void Drag::push(PairedBodies& bodies) const {
  for (const Area& area : areas_) {
    const Vector3d arm = bodies.rotation(area.body) * area.position;
    const Vector3d pushing = force(
        area, bodies.linear_velocity(area.body) + bodies.angular_velocity(area.body).cross(arm));
    bodies.push(area.body, pushing, arm.cross(pushing));
  }
}

// velocity: of the area's point, world axes.
Vector3d Drag::force(const Area& area, const Vector3d& velocity) const {
  const Vector3d against_air = velocity - wind_;
  return -area.factor * against_air.norm() * against_air;
}

}  // namespace codesign::dynamics
