#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

// A path through way-points: position and yaw relative to the start, as smooth functions of time.
namespace codesign::dynamics {

// How a path goes through its points.
enum class WaypointKind {
  kStop,     // at rest in every way-point: minimum-jerk legs
  kThrough,  // least integral of the squared jerk through all way-points, at rest at both ends
};

// A point of a path.
struct Waypoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // from the start, world axes [m]
  double yaw = 0.0;                                    // from the start's [rad]
  double duration = 1.0;                               // to get there [s]
  double rest = 0.0;                                   // there [s]; splits a `through` path
};

// A path as it is asked for.
struct WaypointPath {
  double start = 0.0;  // time at the start position [s]
  std::vector<Waypoint> waypoints;
  WaypointKind kind = WaypointKind::kStop;
};

// Position (x, y, z) and yaw with three derivatives.
struct PathPoint {
  Eigen::Vector4d value = Eigen::Vector4d::Zero();         // [m, rad]
  Eigen::Vector4d velocity = Eigen::Vector4d::Zero();      // [m/s, rad/s]
  Eigen::Vector4d acceleration = Eigen::Vector4d::Zero();  // [m/s², rad/s²]
  Eigen::Vector4d jerk = Eigen::Vector4d::Zero();          // [m/s³, rad/s³]
};

// The path as polynomials of degree five. After its end it holds.
class Path {
 public:
  Path() = default;  // stays at the start
  // Throws std::invalid_argument: a duration that is not positive, a negative rest or start, a
  // value that is not finite.
  explicit Path(const WaypointPath& path);

  PathPoint at(double time) const;
  double end() const { return end_; }  // [s]
  // Largest speed [m/s] and acceleration [m/s²] of the position, sampled 100 times a leg.
  double peak_speed() const;
  double peak_acceleration() const;

 private:
  // Coefficients of (τ/duration)^k in column k, τ the time since the start.
  struct Leg {
    double start = 0.0, duration = 1.0;
    Eigen::Matrix<double, 4, 6> coefficients = Eigen::Matrix<double, 4, 6>::Zero();
  };
  void add_spline(const Eigen::Matrix<double, 4, Eigen::Dynamic>& knots,
                  const std::vector<double>& durations, double start);
  double peak(Eigen::Vector4d PathPoint::*derivative) const;

  std::vector<Leg> legs_;
  Eigen::Vector4d last_ = Eigen::Vector4d::Zero();
  double end_ = 0.0;
};

}  // namespace codesign::dynamics
