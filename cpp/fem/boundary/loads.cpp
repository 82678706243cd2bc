#include "fem/boundary/loads.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>

#include "fem/boundary/bearing.hpp"
#include "fem/mesh/tet10.hpp"
#include "model_error.hpp"

namespace codesign::fem {

namespace {

void add_at_node(Eigen::VectorXd& f, int node, const Eigen::Vector3d& force) {
  f.segment<3>(3 * static_cast<Eigen::Index>(node)) += force;
}

// Calls visit(triangle, point, weight) at every integration point; point.area times weight is the
// area vector that belongs to it.
template <typename Visit>
void integrate_faces(const TetMesh& mesh, const std::vector<int>& triangles,
                     const TriangleRule& rule, const Visit& visit) {
  for (const int t : triangles) {
    const FaceNodes x = face_nodes(mesh, t);
    for (std::size_t q = 0; q < rule.points.size(); ++q) {
      visit(t, evaluate_face(x, rule.points[q]), rule.weights[q]);
    }
  }
}

void spread(const TetMesh& mesh, int triangle, const FacePoint& p, const Eigen::Vector3d& force,
            Eigen::VectorXd& f) {
  for (int k = 0; k < 6; ++k) add_at_node(f, mesh.boundary(triangle, k), p.values[k] * force);
}

void require_finite(bool finite, const char* what) {
  if (!finite) throw std::invalid_argument(std::string(what) + " must be finite");
}

void add_traction(const TetMesh& mesh, const std::vector<int>& triangles,
                  const Eigen::Vector3d& traction, Eigen::VectorXd& f) {
  integrate_faces(mesh, triangles, triangle_rule_12(),
                  [&](int t, const FacePoint& p, double weight) {
                    spread(mesh, t, p, weight * p.area.norm() * traction, f);
                  });
}

struct LoadAdder {
  const TetMesh& mesh;
  const Material& material;
  Eigen::VectorXd& f;

  void operator()(const Force& load) const {
    require_finite(load.force.allFinite(), "force");
    if (load.where.faces.empty() && load.where.triangles.empty()) {
      const std::vector<int> nodes = selected_nodes(mesh, load.where);
      for (const int n : nodes) add_at_node(f, n, load.force / static_cast<double>(nodes.size()));
      return;
    }
    if (!load.where.nodes.empty()) {
      throw std::invalid_argument("a Force acts on faces or on nodes, not on both at once");
    }
    const std::vector<int> triangles = selected_triangles(mesh, load.where);
    const double area = face_area(mesh, triangles);
    if (!(area > 0)) throw ModelError("the faces of a force have no area to spread it over");
    add_traction(mesh, triangles, load.force / area, f);
  }

  void operator()(const Traction& load) const {
    require_finite(load.traction.allFinite(), "traction");
    add_traction(mesh, selected_triangles(mesh, load.where), load.traction, f);
  }

  void operator()(const Pressure& load) const {
    require_finite(std::isfinite(load.pressure), "pressure");
    integrate_faces(mesh, selected_triangles(mesh, load.where), triangle_rule_12(),
                    [&](int t, const FacePoint& p, double weight) {
                      spread(mesh, t, p, -load.pressure * weight * p.area, f);
                    });
  }

  void operator()(const BearingLoad& load) const {
    require_finite(load.force.allFinite(), "bearing load");
    const std::vector<int> triangles = selected_triangles(mesh, load.where);
    const Eigen::Vector3d c = bearing_pressure(mesh, triangles, load.force);
    integrate_faces(mesh, triangles, triangle_rule_12(),
                    [&](int t, const FacePoint& p, double weight) {
                      const double pressure = std::max(0.0, -p.area.normalized().dot(c));
                      spread(mesh, t, p, -pressure * weight * p.area, f);
                    });
  }

  void operator()(const AffineTraction& load) const;

  void operator()(const Acceleration& load) const {
    require_finite(
        load.acceleration.allFinite() && load.gradient.allFinite() && load.point.allFinite(),
        "acceleration, its gradient and point");
    const Eigen::RowVector3d uniform = material.density * load.acceleration.transpose();
    if (load.gradient.isZero(0.0)) {
      (*this)(BodyForce{uniform});
      return;
    }
    Points force = (mesh.nodes.rowwise() - load.point.transpose()) *
                   (material.density * load.gradient.transpose());
    force.rowwise() += uniform;
    (*this)(BodyForce{std::move(force)});
  }

  void operator()(const BodyForce& load) const {
    require_finite(load.force.allFinite(), "body force");
    const bool uniform = load.force.rows() == 1;
    if (!uniform && load.force.rows() != mesh.nodes.rows()) {
      throw std::invalid_argument("a body force has one row, or one row per node");
    }
    const TetRule& rule = tet_rule_14();
    TetPoints points;
    for (int e = 0; e < mesh.tets.rows(); ++e) {
      evaluate_tet(tet_nodes(mesh, e), rule, points);
      for (int q = 0; q < points.count; ++q) {
        const TetValues n = tet10_values(rule.points[static_cast<std::size_t>(q)]);
        Eigen::Vector3d b = Eigen::Vector3d::Zero();
        for (int i = 0; i < kTetNodes; ++i) {
          b += n[i] * load.force.row(uniform ? 0 : mesh.tets(e, i)).transpose();
        }
        const double weight = points.weights[static_cast<std::size_t>(q)];
        for (int i = 0; i < kTetNodes; ++i) add_at_node(f, mesh.tets(e, i), weight * n[i] * b);
      }
    }
  }
};

bool inside(const std::optional<Disc>& region, const Eigen::Vector3d& x) {
  if (!region) return true;
  const Eigen::Vector3d r = x - region->center;
  const Eigen::Vector3d axis = region->axis.normalized();
  return (r - r.dot(axis) * axis).squaredNorm() <= region->radius * region->radius;
}

Eigen::Vector3d image(const Plane& mirror, const Eigen::Vector3d& x) {
  return x - 2.0 * mirror.normal.dot(x - mirror.point) * mirror.normal;
}

// With t = a + b x r, r = x - point: force = A a + b x s and moment = s x a + J b, where A is the
// area, s the first moment of r and J = integral of |r|² I - r rᵀ: six equations.
void LoadAdder::operator()(const AffineTraction& load) const {
  require_finite(load.force.allFinite() && load.moment.allFinite() && load.point.allFinite(),
                 "force, moment and point");
  const std::vector<int> triangles = selected_triangles(mesh, load.where);
  const TriangleRule rule = load.region ? subdivided_triangle_rule(8) : triangle_rule_12();
  double area = 0.0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  const auto add = [&](const Eigen::Vector3d& r, double w) {
    area += w;
    first += w * r;
    second += w * r * r.transpose();
  };
  integrate_faces(mesh, triangles, rule, [&](int, const FacePoint& p, double weight) {
    if (!inside(load.region, p.position)) return;
    add(p.position - load.point, weight * p.area.norm());
    if (load.mirror) add(image(*load.mirror, p.position) - load.point, weight * p.area.norm());
  });
  if (!(area > 0)) throw ModelError("the region of a load contains no surface");

  // Solved about the centroid with lengths scaled, where the system is well conditioned.
  const Eigen::Vector3d centroid = first / area;
  second -= area * centroid * centroid.transpose();
  const Eigen::Matrix3d inertia = second.trace() * Eigen::Matrix3d::Identity() - second;
  const Eigen::Vector3d moment = load.moment - centroid.cross(load.force);
  const Eigen::Vector3d a = load.force / area;
  const Eigen::Vector3d b = inertia.ldlt().solve(moment);
  integrate_faces(mesh, triangles, rule, [&](int t, const FacePoint& p, double weight) {
    if (!inside(load.region, p.position)) return;
    const Eigen::Vector3d r = p.position - load.point - centroid;
    spread(mesh, t, p, weight * p.area.norm() * (a + b.cross(r)), f);
  });
}

}  // namespace

Eigen::VectorXd load_vector(const TetMesh& mesh, const Material& material,
                            const std::vector<Load>& loads) {
  Eigen::VectorXd f = Eigen::VectorXd::Zero(3 * mesh.nodes.rows());
  for (const Load& load : loads) std::visit(LoadAdder{mesh, material, f}, load);
  return f;
}

std::vector<int> loaded_triangles(const TetMesh& mesh, const std::vector<Load>& loads) {
  std::vector<int> result;
  for (const Load& load : loads) {
    const Selection* where = std::visit(
        [](const auto& l) -> const Selection* {
          // A load on a region fades inside its faces: their border is no border of the load.
          if constexpr (requires { l.region; })
            if (l.region) return nullptr;
          if constexpr (requires { l.where; }) return &l.where;
          return nullptr;
        },
        load);
    if (where == nullptr || (where->faces.empty() && where->triangles.empty())) continue;
    const std::vector<int> triangles = selected_triangles(mesh, *where);
    result.insert(result.end(), triangles.begin(), triangles.end());
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

double face_area(const TetMesh& mesh, const std::vector<int>& triangles) {
  double area = 0.0;
  integrate_faces(mesh, triangles, triangle_rule_12(),
                  [&](int, const FacePoint& p, double weight) { area += weight * p.area.norm(); });
  return area;
}

}  // namespace codesign::fem
