#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "box_mesh.hpp"
#include "fem/boundary/loads.hpp"
#include "model_error.hpp"

using namespace codesign::fem;
using Eigen::Vector3d;

namespace {

const Material kMaterial{"steel", 210e9, 0.3, 7850.0, 250e6};

// Quarter of a tube of inner radius 1 and outer radius 2, height 1/2, with curved elements.
TetMesh quarter_tube() {
  return box_mesh(2, 4, 1, [](const Vector3d& x) -> Vector3d {
    const double r = 1 + x[0], t = x[1] * M_PI / 2;
    return {r * std::cos(t), r * std::sin(t), 0.5 * x[2]};
  });
}

Selection inner_face(const TetMesh& mesh) {
  Selection s;
  for (int t = 0; t < mesh.boundary.rows(); ++t) {
    bool inside = true;
    for (int k = 0; k < 3; ++k)
      inside &= mesh.nodes.row(mesh.boundary(t, k)).head<2>().norm() < 1 + 1e-9;
    if (inside) s.triangles.push_back(t);
  }
  return s;
}

Selection top_face(const TetMesh& mesh) {
  return {{}, triangles_with_normal(mesh, {0, 0, 1}, 1e-6), {}};
}

Vector3d net_force(const Eigen::VectorXd& f) {
  Vector3d sum = Vector3d::Zero();
  for (Eigen::Index i = 0; i < f.size(); i += 3) sum += f.segment<3>(i);
  return sum;
}

Vector3d net_moment(const TetMesh& mesh, const Eigen::VectorXd& f, const Vector3d& point) {
  Vector3d sum = Vector3d::Zero();
  for (Eigen::Index n = 0; n < mesh.nodes.rows(); ++n) {
    sum += (mesh.nodes.row(n).transpose() - point).cross(Vector3d(f.segment<3>(3 * n)));
  }
  return sum;
}

// On the half y >= 0.5 of a box, the loads of its nodes off the plane are those of the whole box,
// whatever the symmetry of force and moment.
TEST(Loads, AMirroredTractionIsHalfOfTheWhole) {
  const TetMesh whole = box_mesh(2, 4, 2);
  TetMesh half = box_mesh(2, 2, 2);
  half.nodes.col(1) = (0.5 * half.nodes.col(1)).array() + 0.5;
  const Vector3d force(1.0, 2.0, 3.0), point(0.2, 0.5, 1.3), moment(0.3, -0.4, 0.7);
  const Plane plane{Vector3d(0.0, 0.5, 0.0), Vector3d::UnitY()};
  const Eigen::VectorXd of_whole = load_vector(
      whole, kMaterial, {AffineTraction{top_face(whole), force, point, moment, {}, {}}});
  const Eigen::VectorXd of_half = load_vector(
      half, kMaterial, {AffineTraction{top_face(half), force, point, moment, {}, plane}});
  int compared = 0;
  for (Eigen::Index n = 0; n < half.nodes.rows(); ++n) {
    if (half.nodes(n, 1) < 0.5 + 1e-9) continue;
    for (Eigen::Index m = 0; m < whole.nodes.rows(); ++m) {
      if ((whole.nodes.row(m) - half.nodes.row(n)).norm() > 1e-9) continue;
      EXPECT_LT((of_whole.segment<3>(3 * m) - of_half.segment<3>(3 * n)).norm(), 1e-12);
      ++compared;
    }
  }
  EXPECT_GT(compared, 50);
}

}  // namespace

TEST(Loads, PressureOnACurvedFaceHasTheExactResultantOfItsBorder) {
  const TetMesh mesh = quarter_tube();
  const Eigen::VectorXd f = load_vector(mesh, kMaterial, {Pressure{inner_face(mesh), 2.0}});
  // A closed border fixes the vector area: 1 x 1/2 in the directions +x and +y.
  EXPECT_LT((net_force(f) - Vector3d(1, 1, 0)).norm(), 1e-13);
  EXPECT_LT(net_moment(mesh, f, Vector3d(0, 0, 0.25)).head<2>().norm(), 1e-13);
}

TEST(Loads, ForceIsSpreadUniformlyAndItsSumIsExact) {
  const TetMesh mesh = quarter_tube();
  const Vector3d force(3, -4, 5);
  const Eigen::VectorXd f = load_vector(mesh, kMaterial, {Force{inner_face(mesh), force}});
  EXPECT_LT((net_force(f) - force).norm(), 1e-13);
  // The centroid of a quarter circle is at 2/pi; curved quadratic faces miss the circle by 1e-5.
  const Vector3d centroid(2 / M_PI, 2 / M_PI, 0.25);
  EXPECT_LT(net_moment(mesh, f, centroid).norm(), 1e-4 * force.norm());
}

TEST(Loads, ForceOnNodesIsSharedInEqualParts) {
  const TetMesh mesh = box_mesh(1, 1, 1);
  const Eigen::VectorXd f = load_vector(mesh, kMaterial, {Force{{{}, {}, {2, 5}}, {0, 0, 8}}});
  EXPECT_DOUBLE_EQ(f[3 * 2 + 2], 4.0);
  EXPECT_DOUBLE_EQ(f[3 * 5 + 2], 4.0);
  EXPECT_DOUBLE_EQ(f.cwiseAbs().sum(), 8.0);
}

TEST(Loads, AffineTractionHasTheGivenForceAndMoment) {
  const TetMesh mesh = quarter_tube();
  const Vector3d force(1, 2, -250), moment(4, -3, 2), point(5, -1, 2);
  for (const bool limited : {false, true}) {
    AffineTraction load{top_face(mesh), force, point, moment, std::nullopt};
    if (limited) load.region = Disc{{1.1, 1.0, 0.5}, {0, 0, 1}, 0.37};
    const Eigen::VectorXd f = load_vector(mesh, kMaterial, {load});
    EXPECT_LT((net_force(f) - force).norm(), 1e-11 * force.norm());
    EXPECT_LT((net_moment(mesh, f, point) - moment).norm(), 1e-11 * force.norm() * point.norm());
  }
}

TEST(Loads, AffineTractionThroughTheCentroidIsUniform) {
  const TetMesh mesh = box_mesh(2, 2, 2);
  const Vector3d force(1, 2, 3);
  const Eigen::VectorXd affine = load_vector(
      mesh, kMaterial,
      {AffineTraction{
          top_face(mesh), force, {0.5, 0.5, 1}, Vector3d::Zero(), std::nullopt, std::nullopt}});
  const Eigen::VectorXd uniform = load_vector(mesh, kMaterial, {Force{top_face(mesh), force}});
  EXPECT_LT((affine - uniform).norm(), 1e-14);
}

TEST(Loads, ADiscLimitsTheTractionToItsInside) {
  const TetMesh mesh = box_mesh(8, 8, 1);
  AffineTraction load{top_face(mesh),
                      {0, 0, 1},
                      {0.25, 0.25, 1},
                      Vector3d::Zero(),
                      Disc{{0.25, 0.25, 0}, {0, 0, 2}, 0.2}};
  const Eigen::VectorXd f = load_vector(mesh, kMaterial, {load});
  for (Eigen::Index n = 0; n < mesh.nodes.rows(); ++n) {
    const bool outside = mesh.nodes(n, 0) > 0.6 || mesh.nodes(n, 1) > 0.6;
    EXPECT_TRUE(!outside || f.segment<3>(3 * n).norm() == 0.0);
  }
  load.region->radius = 1e-4;
  load.region->center = Vector3d(7, 7, 0);
  EXPECT_THROW(load_vector(mesh, kMaterial, {load}), codesign::ModelError);
}

TEST(Loads, AccelerationPullsWithTheMass) {
  const TetMesh mesh = box_mesh(
      2, 2, 2, [](const Vector3d& x) -> Vector3d { return x + 0.1 * Vector3d(x[1] * x[1], 0, 0); });
  const Eigen::VectorXd f = load_vector(mesh, kMaterial, {Acceleration{{0, 0, -9.81}}});
  EXPECT_LT((net_force(f) - Vector3d(0, 0, -9.81 * 7850)).norm(), 1e-9 * 9.81 * 7850);
}

TEST(Loads, RefusesWhatMakesNoSense) {
  const TetMesh mesh = box_mesh(1, 1, 1);
  const double nan = std::nan("");
  EXPECT_THROW(load_vector(mesh, kMaterial, {Force{{{"seat"}, {}, {}}, {1, 0, 0}}}),
               codesign::ModelError);
  EXPECT_THROW(load_vector(mesh, kMaterial, {Force{{}, {1, 0, 0}}}), codesign::ModelError);
  EXPECT_THROW(load_vector(mesh, kMaterial, {Force{{{}, {0}, {1}}, {1, 0, 0}}}),
               std::invalid_argument);
  EXPECT_THROW(load_vector(mesh, kMaterial, {Force{{{}, {}, {99}}, {1, 0, 0}}}),
               std::invalid_argument);
  EXPECT_THROW(load_vector(mesh, kMaterial, {Pressure{{{}, {0}, {}}, nan}}), std::invalid_argument);
  EXPECT_THROW(load_vector(mesh, kMaterial, {BodyForce{Points::Zero(3, 3)}}),
               std::invalid_argument);
}
