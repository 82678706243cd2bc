#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace codesign::fem {

// What a smooth face is a piece of; its name for people.
enum class SurfaceType { plane, cylinder, cone, sphere, free };
std::string surface_type_name(SurfaceType type);

// A plane, a sphere, or a surface of revolution with a straight generatrix (cylinder, cone).
struct Primitive {
  SurfaceType type = SurfaceType::free;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  // of the plane, of the axis; the center
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  // unit; the plane's normal
  double radius = 0.0;                              // m; of a cone: at `point`
  double slope = 0.0;                               // of a cone: growth of the radius per length

  double distance(const Eigen::Vector3d& x) const;         // m, signed
  Eigen::Vector3d normal(const Eigen::Vector3d& x) const;  // unit, away from axis or center
};

// Pieces of a surface to fit: all corners, and of each flat piece centroid, unit normal and area.
struct FitData {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3d> centroids;
  std::vector<Eigen::Vector3d> normals;
  std::vector<double> areas;
};

// Least-squares fits; type free if the data do not determine the shape.
Primitive fit_sphere(const FitData& data);
Primitive fit_cylinder(const FitData& data);
Primitive fit_cone(const FitData& data);

}  // namespace codesign::fem
