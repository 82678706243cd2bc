#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bindings/bindings.hpp"
#include "dynamics/convex_distance.hpp"

namespace py = pybind11;

namespace codesign {
namespace {

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Indices = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;
using Hull = Eigen::Map<const Eigen::Matrix3Xd>;  // the transpose of a C-contiguous (n, 3) array
using RowMajor4d = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

Hull hull(const Array& points, std::size_t number) {
  if (points.ndim() != 2 || points.shape(0) < 1 || points.shape(1) != 3) {
    throw std::invalid_argument("hull " + std::to_string(number) +
                                " must have shape (n, 3), n > 0");
  }
  const Hull map(points.data(), 3, points.shape(0));
  if (!map.allFinite()) {
    throw std::invalid_argument("hull " + std::to_string(number) + " must be finite");
  }
  return map;
}

void check_pairs(const Indices& first, const Indices& second, const Array& poses,
                 std::size_t hulls) {
  const py::ssize_t count = first.size();
  if (first.ndim() != 1 || second.ndim() != 1 || second.size() != count) {
    throw std::invalid_argument("first and second must have the same shape (m,)");
  }
  if (poses.ndim() != 3 || poses.shape(0) != count || poses.shape(1) != 4 || poses.shape(2) != 4) {
    throw std::invalid_argument("first_T_second must have shape (m, 4, 4)");
  }
  const auto limit = static_cast<std::int64_t>(hulls);
  for (py::ssize_t i = 0; i < count; ++i) {
    for (const std::int64_t number : {first.at(i), second.at(i)}) {
      if (number < 0 || number >= limit) {
        throw std::invalid_argument("pair " + std::to_string(i) + ": there is no hull " +
                                    std::to_string(number));
      }
    }
  }
  if (!Eigen::Map<const Eigen::VectorXd>(poses.data(), poses.size()).allFinite()) {
    throw std::invalid_argument("first_T_second must be finite");
  }
}

Array hull_distances(const std::vector<Array>& hulls, const Indices& first, const Indices& second,
                     const Array& first_T_second) {
  std::vector<Hull> maps;
  for (std::size_t k = 0; k < hulls.size(); ++k) maps.push_back(hull(hulls[k], k));
  check_pairs(first, second, first_T_second, hulls.size());
  Array result(first.size());
  double* const out = result.mutable_data();
  {
    py::gil_scoped_release release;
    for (py::ssize_t i = 0; i < first.size(); ++i) {
      const Eigen::Map<const RowMajor4d> T(first_T_second.data() + 16 * i);
      const dynamics::Pose pose{T.topLeftCorner<3, 3>(), T.topRightCorner<3, 1>()};
      out[i] = dynamics::signed_distance(maps[first.data()[i]], maps[second.data()[i]], pose);
    }
  }
  return result;
}

using Numbers = Eigen::Matrix<std::int64_t, Eigen::Dynamic, 2, Eigen::RowMajor>;

std::vector<dynamics::PiecewiseConvex> convex_bodies(
    const std::vector<std::vector<Array>>& bodies) {
  std::vector<dynamics::PiecewiseConvex> made;
  for (const std::vector<Array>& pieces : bodies) {
    if (pieces.empty()) throw std::invalid_argument("a body must have a piece");
    std::vector<Hull> maps;
    for (std::size_t k = 0; k < pieces.size(); ++k) maps.push_back(hull(pieces[k], k));
    made.emplace_back(std::move(maps));
  }
  return made;
}

std::vector<std::vector<dynamics::Pose>> body_poses(const Array& poses, std::size_t bodies) {
  if (poses.ndim() != 4 || poses.shape(0) != static_cast<py::ssize_t>(bodies) ||
      poses.shape(1) < 1 || poses.shape(2) != 4 || poses.shape(3) != 4) {
    throw std::invalid_argument("poses must have shape (bodies, n, 4, 4), n > 0");
  }
  if (!Eigen::Map<const Eigen::VectorXd>(poses.data(), poses.size()).allFinite()) {
    throw std::invalid_argument("poses must be finite");
  }
  std::vector<std::vector<dynamics::Pose>> made(bodies);
  const double* next = poses.data();
  for (auto& of_body : made) {
    for (py::ssize_t k = 0; k < poses.shape(1); ++k, next += 16) {
      const Eigen::Map<const RowMajor4d> T(next);
      of_body.push_back({T.topLeftCorner<3, 3>(), T.topRightCorner<3, 1>()});
    }
  }
  return made;
}

// Centers of the spheres around bodies, in the root's axes, by body and posture.
std::vector<std::vector<Eigen::Vector3d>> body_centers(
    const std::vector<dynamics::PiecewiseConvex>& bodies,
    const std::vector<std::vector<dynamics::Pose>>& root_T_body) {
  std::vector<std::vector<Eigen::Vector3d>> centers(bodies.size());
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const Eigen::Vector3d& center = bodies[k].sphere().center;
    for (const dynamics::Pose& pose : root_T_body[k])
      centers[k].push_back(pose.R * center + pose.p);
  }
  return centers;
}

// Whether two centers are nowhere as near to each other as that.
bool stay_apart(const std::vector<Eigen::Vector3d>& first,
                const std::vector<Eigen::Vector3d>& second, double distance) {
  for (std::size_t i = 0; i < first.size(); ++i) {
    if ((first[i] - second[i]).squaredNorm() < distance * distance) return false;
  }
  return true;
}

py::tuple nearest_approaches(const std::vector<std::vector<Array>>& bodies, const Array& poses,
                             const Numbers& pairs, double limit) {
  const std::vector<dynamics::PiecewiseConvex> made = convex_bodies(bodies);
  const std::vector<std::vector<dynamics::Pose>> root_T_body = body_poses(poses, made.size());
  if (pairs.size() > 0 &&
      (pairs.minCoeff() < 0 || pairs.maxCoeff() >= static_cast<std::int64_t>(made.size()))) {
    throw std::invalid_argument("pairs must be numbers of bodies");
  }
  Eigen::VectorXd distances(pairs.rows());
  Eigen::Matrix<std::int64_t, Eigen::Dynamic, 1> postures(pairs.rows());
  {
    py::gil_scoped_release release;
    const auto centers = body_centers(made, root_T_body);
    std::vector<dynamics::Pose> first_T_second;
    for (Eigen::Index k = 0; k < pairs.rows(); ++k) {
      const auto& first = root_T_body[pairs(k, 0)];
      const auto& second = root_T_body[pairs(k, 1)];
      const double near =
          limit + made[pairs(k, 0)].sphere().radius + made[pairs(k, 1)].sphere().radius;
      if (near <= 0.0 || stay_apart(centers[pairs(k, 0)], centers[pairs(k, 1)], near)) {
        distances[k] = limit;
        postures[k] = 0;
        continue;
      }
      first_T_second.clear();
      for (std::size_t i = 0; i < first.size(); ++i) {
        first_T_second.push_back(dynamics::inverse(first[i]) * second[i]);
      }
      const dynamics::Approach nearest =
          dynamics::nearest_approach(made[pairs(k, 0)], made[pairs(k, 1)], first_T_second, limit);
      distances[k] = nearest.distance;
      postures[k] = static_cast<std::int64_t>(nearest.posture);
    }
  }
  return py::make_tuple(distances, postures);
}

}  // namespace

void bind_convex(py::module_& m) {
  m.def("hull_distances", &hull_distances, py::arg("hulls"), py::arg("first"), py::arg("second"),
        py::arg("first_T_second"),
        R"(Signed distances of pairs of convex hulls.

Args:
    hulls: points (n, 3) of each hull in its own frame [m]; points inside a hull do no harm.
    first, second: (m,) numbers of the hulls of each pair.
    first_T_second: (m, 4, 4) pose of the second hull's frame in the first's.
Returns: (m,) [m]; where two hulls overlap, minus the length of the shortest translation that parts them.
Raises: ValueError for wrong shapes, numbers or values that are not finite.
Source: Gilbert, Johnson, Keerthi (1988); van den Bergen (2001).)");
  m.def("nearest_approaches", &nearest_approaches, py::arg("bodies"), py::arg("poses"),
        py::arg("pairs"), py::arg("limit"),
        R"(Where pairs of moving bodies come nearest.

Args:
    bodies: points (k, 3) of each convex piece of each body, in its frame [m].
    poses: (bodies, n, 4, 4) of the bodies' frames in one frame, in n postures.
    pairs: (m, 2) numbers of bodies.
    limit: distances [m] from here on are not told apart.
Returns: (m,) smallest signed distances [m] as `hull_distances` gives them, the limit where none is below, and (m,)
    numbers of the postures where they occur.
Raises: ValueError for wrong shapes, numbers or values that are not finite.)");
}

}  // namespace codesign
