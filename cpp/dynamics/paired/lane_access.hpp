#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstring>

#include "dynamics/paired/lanes.hpp"

// One lane of what lanes.hpp has two of.
namespace codesign::dynamics {

// Writes the vector of one lane.
inline void set_lane(LaneVector& v, int lane, const Eigen::Vector3d& value) {
  v.x[lane] = value.x(), v.y[lane] = value.y(), v.z[lane] = value.z();
}

// The vector of one lane.
inline Eigen::Vector3d of_lane(const LaneVector& v, int lane) {
  return {v.x[lane], v.y[lane], v.z[lane]};
}

// The whole matrix of one lane.
inline Eigen::Matrix3d of_lane(const LaneSymmetric& m, int lane) {
  Eigen::Matrix3d full;
  full << of_lane(m.column_x(), lane), of_lane(m.column_y(), lane), of_lane(m.column_z(), lane);
  return full;
}

// How many Lanes a struct made of Lanes has.
template <class T>
constexpr std::size_t kLaneCount = sizeof(T) / sizeof(Lanes);

// Number `index` of one lane, of a struct made of Lanes.
inline double read_lane(const void* from, std::size_t index, int lane) {
  double value;
  std::memcpy(&value,
              static_cast<const char*>(from) + index * sizeof(Lanes) +
                  static_cast<std::size_t>(lane) * sizeof(double),
              sizeof(double));
  return value;
}

// Writes such a number.
inline void write_lane(void* to, std::size_t index, int lane, double value) {
  std::memcpy(static_cast<char*>(to) + index * sizeof(Lanes) +
                  static_cast<std::size_t>(lane) * sizeof(double),
              &value, sizeof(double));
}

// The lane of `from` added to a lane of `to`.
template <class T>
void add_lane(const T& from, int from_lane, T& to, int to_lane) {
  for (std::size_t i = 0; i < kLaneCount<T>; ++i) {
    write_lane(&to, i, to_lane, read_lane(&to, i, to_lane) + read_lane(&from, i, from_lane));
  }
}

}  // namespace codesign::dynamics
