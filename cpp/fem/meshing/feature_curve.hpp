#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace codesign::fem {

// A polyline measured by its arc length, closed if its first and last point are equal. Points on it
// are given by their coordinates; those that the curve has handed out or is made of are recognized,
// others are taken to the nearest point.
class FeatureCurve {
 public:
  explicit FeatureCurve(std::vector<Eigen::Vector3d> points);

  const std::vector<Eigen::Vector3d>& points() const { return points_; }
  bool is_closed() const { return points_.front() == points_.back(); }
  double length() const { return arc_.back(); }

  // Arc length of a point of the curve; 0 at the start of a closed curve.
  double position(const Eigen::Vector3d& p) const;

  // Length from p to q, walking in the direction of the curve or against it.
  double length_between(const Eigen::Vector3d& p, const Eigen::Vector3d& q, bool forward) const;

  // The point at a signed distance from p; past an end of an open curve, that end.
  Eigen::Vector3d point_at(const Eigen::Vector3d& p, double distance) const;

  // Whether the piece from p to q lies in the union of two balls about p and q.
  bool is_covered(const Eigen::Vector3d& p, double squared_radius_p, const Eigen::Vector3d& q,
                  double squared_radius_q, bool forward) const;

  // The nearest point of the curve.
  Eigen::Vector3d nearest(const Eigen::Vector3d& p) const;

 private:
  struct Key {
    double x, y, z;
    bool operator==(const Key&) const = default;
  };
  struct KeyHash {
    std::size_t operator()(const Key& key) const;
  };

  double nearest_position(const Eigen::Vector3d& p) const;
  Eigen::Vector3d at(double arc) const;
  std::size_t segment(double arc) const;

  std::vector<Eigen::Vector3d> points_;
  std::vector<double> arc_;
  mutable std::unordered_map<Key, double, KeyHash> known_;
};

}  // namespace codesign::fem
