#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace codesign::fem {

using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
using Triangles = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;

// A closed, outward-oriented triangulated surface whose triangles belong to faces.
// Face k has the name face_names[k]; borders between different faces are kept as feature lines by
// the mesher.
struct SurfaceMesh {
  Points points;                        // (n, 3) m
  Triangles triangles;                  // (m, 3) counter-clockwise seen from outside
  std::vector<int> face;                // (m) index into face_names
  std::vector<std::string> face_names;  // unnamed surface has the name ""
};

}  // namespace codesign::fem
