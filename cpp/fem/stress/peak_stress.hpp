#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/mesh/tet10.hpp"
#include "fem/mesh/tet_mesh.hpp"
#include "fem/stress/exclusion.hpp"
#include "fem/stress/recovery.hpp"
#include "fem/stress/stress.hpp"

namespace codesign::fem {

// A largest von Mises stress and its place [m].
struct PeakStress {
  double value = 0.0;  // Pa
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  int triangle = -1;  // row of TetMesh::boundary; -1: inside the part
  int element = -1;   // if inside
  Eigen::Vector2d reference = Eigen::Vector2d::Zero();  // where in the triangle

  bool read() const { return triangle >= 0 || element >= 0; }  // false: no place yet
};

// Columns: the stress at the nodes of a boundary face, of an element.
using FaceStress = Eigen::Matrix<double, 6, 6>;
using ElementStress = Eigen::Matrix<double, 6, kTetNodes>;

// Where a boundary face is sampled: 66 points with the values of its shape functions there.
struct FaceSample {
  Eigen::Vector2d reference;
  Eigen::Matrix<double, 6, 1> values;
};
const std::vector<FaceSample>& face_samples();

// How a face lies to what is left out; a face that lies on one side as a whole needs no look at its
// points.
enum class Side { outside, inside, both };
Side side_of_face(const TetMesh& mesh, int triangle, const ExclusionZone& zone);

// Raises a peak to the largest sample of one face outside the zone (left_out: inside it), and of
// the four points of an element outside it, where these are above.
void raise_on_face(const TetMesh& mesh, const FaceStress& stress, int triangle,
                   const ExclusionZone& zone, bool left_out, PeakStress& peak);
void raise_in_element(const TetMesh& mesh, const ElementStress& stress, int element,
                      const ExclusionZone& zone, PeakStress& peak);

// A zone that holds everything. Throws ModelError.
[[noreturn]] void throw_no_place_left();

// Largest von Mises stress of the nodal stress interpolated over the boundary faces, sampled at 66
// points per face, outside the zone. Throws ModelError if the zone leaves no point.
PeakStress peak_stress(const TetMesh& mesh, const Stresses& nodal, const ExclusionZone& zone);

// The largest such stress inside the zone; value 0 if the zone holds no point of the surface.
PeakStress stress_left_out(const TetMesh& mesh, const Stresses& nodal, const ExclusionZone& zone);

// True if the peak lies within a fifth of its face's (element's) longest edge of what the zone
// leaves out: then it is what the growing stress beside a clamp has come down to at that distance,
// a convention rather than a property of the part.
bool beside_exclusion(const TetMesh& mesh, const PeakStress& peak, const ExclusionZone& zone);

// The same field inside the part, at the four points of each element, outside the zone.
struct VolumeStress {
  double exceeded = 0.0;  // Pa, in the given volume; the smallest stress if there is less material
  PeakStress largest;     // value 0 if the zone leaves no point
};
VolumeStress volume_stress(const TetMesh& mesh, const Stresses& nodal, const PointStresses& points,
                           const ExclusionZone& zone, double volume);

// Estimated error (Pa) of the peak stress, from an indicator x: the spread of the recovery there
// plus 0.4 times the largest root mean square difference between finite-element and recovered
// stress over the elements around the face, relative to the peak. Calibrated on the study's parts
// (docs/fem.md): sqrt(3 %² + (x / 2)²) + 23 x³. The first term is the noise of a largest of many
// values, the last one counts where elements are too coarse for x to be proportional to the error.
// An estimate, not a bound.
double peak_stress_error(const TetMesh& mesh, const std::vector<BodyPlace>& places,
                         const PointStresses& points, const RecoveryError& recovery,
                         const PeakStress& peak);

}  // namespace codesign::fem
