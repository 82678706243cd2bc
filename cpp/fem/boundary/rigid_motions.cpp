#include "fem/boundary/rigid_motions.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <numeric>
#include <set>
#include <sstream>

#include "errors.hpp"

namespace codesign::fem {

namespace {

constexpr int kMaxBodies = 200;           // above this the mesh is debris, not a part
constexpr double kRankTolerance = 1e-12;  // relative to the largest eigenvalue of the Gram matrix

std::size_t at(Eigen::Index i) { return static_cast<std::size_t>(i); }

int find_root(std::vector<int>& parent, int i) {
  while (parent[at(i)] != i) i = parent[at(i)] = parent[at(parent[at(i)])];
  return i;
}

// Index of the body of each element; bodies are joined through shared faces.
std::vector<int> element_bodies(const TetMesh& mesh, int& count) {
  constexpr int kFaces[4][3] = {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}};
  std::vector<std::array<int, 4>> faces;
  faces.reserve(4 * at(mesh.tets.rows()));
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    for (const auto& f : kFaces) {
      std::array<int, 4> face{mesh.tets(e, f[0]), mesh.tets(e, f[1]), mesh.tets(e, f[2]), e};
      std::sort(face.begin(), face.begin() + 3);
      faces.push_back(face);
    }
  }
  std::sort(faces.begin(), faces.end());
  std::vector<int> parent(at(mesh.tets.rows()));
  std::iota(parent.begin(), parent.end(), 0);
  for (std::size_t i = 1; i < faces.size(); ++i) {
    if (std::equal(faces[i].begin(), faces[i].begin() + 3, faces[i - 1].begin())) {
      parent[at(find_root(parent, faces[i][3]))] = find_root(parent, faces[i - 1][3]);
    }
  }
  std::vector<int> body(parent.size(), -1), index(parent.size(), -1);
  count = 0;
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    int& k = index[at(find_root(parent, e))];
    if (k < 0) k = count++;
    body[at(e)] = k;
  }
  return body;
}

struct Body {
  Eigen::Vector3d reference = Eigen::Vector3d::Zero();  // mean of its nodes
  double length = 0.0;                                  // scale of rotations
  std::vector<int> nodes;
};

std::vector<Body> make_bodies(const TetMesh& mesh) {
  int count = 0;
  const std::vector<int> body = element_bodies(mesh, count);
  if (count > kMaxBodies) {
    throw MeshError("the mesh falls into " + std::to_string(count) + " separate pieces");
  }
  std::vector<Body> bodies(at(count));
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    for (int i = 0; i < 10; ++i) bodies[at(body[at(e)])].nodes.push_back(mesh.tets(e, i));
  }
  for (Body& b : bodies) {
    std::sort(b.nodes.begin(), b.nodes.end());
    b.nodes.erase(std::unique(b.nodes.begin(), b.nodes.end()), b.nodes.end());
    for (const int n : b.nodes) b.reference += mesh.nodes.row(n).transpose();
    b.reference /= static_cast<double>(b.nodes.size());
    for (const int n : b.nodes) {
      b.length = std::max(b.length, (mesh.nodes.row(n).transpose() - b.reference).norm());
    }
  }
  return bodies;
}

// Displacement of a point of the body by its six coordinates (velocity, rotation times length).
Eigen::Matrix<double, 3, 6> motion_at(const Body& b, const Eigen::Vector3d& x) {
  const Eigen::Vector3d r = (x - b.reference) / b.length;
  Eigen::Matrix<double, 3, 6> m;
  m << 1, 0, 0, 0, r[2], -r[1], 0, 1, 0, -r[2], 0, r[0], 0, 0, 1, r[1], -r[0], 0;
  return m;
}

// Columns: motions of all bodies that meet every constraint.
Eigen::MatrixXd free_motions(const TetMesh& mesh, const Constraints& constraints,
                             const std::vector<Body>& bodies) {
  const Eigen::Index size = 6 * static_cast<Eigen::Index>(bodies.size());
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(size, size);
  std::vector<int> owner(at(mesh.nodes.rows()), -1);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Eigen::Index i = 6 * static_cast<Eigen::Index>(b);
    for (const int n : bodies[b].nodes) {
      const Eigen::Vector3d x = mesh.nodes.row(n).transpose();
      const Eigen::Matrix<double, 3, 6> m = motion_at(bodies[b], x);
      for (int a = 0; a < 3; ++a) {
        if (!constraints.fixed[3 * at(n) + at(a)]) continue;
        gram.block<6, 6>(i, i) += m.row(a).transpose() * m.row(a);
      }
      if (owner[at(n)] < 0) {
        owner[at(n)] = static_cast<int>(b);
        continue;
      }
      const Eigen::Index j = 6 * static_cast<Eigen::Index>(owner[at(n)]);
      const Eigen::Matrix<double, 3, 6> other = motion_at(bodies[at(owner[at(n)])], x);
      gram.block<6, 6>(i, i) += m.transpose() * m;
      gram.block<6, 6>(j, j) += other.transpose() * other;
      gram.block<6, 6>(i, j) -= m.transpose() * other;
      gram.block<6, 6>(j, i) -= other.transpose() * m;
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(gram);
  const double limit = kRankTolerance * std::max(eigen.eigenvalues()[size - 1], 1.0);
  Eigen::Index free = 0;
  while (free < size && eigen.eigenvalues()[free] < limit) ++free;
  return eigen.eigenvectors().leftCols(free);
}

std::string number(double v) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(3);
  out << (std::abs(v) < 1e-9 ? 0.0 : v);
  return out.str();
}

std::string vector_text(const Eigen::Vector3d& v) {
  return "(" + number(v[0]) + ", " + number(v[1]) + ", " + number(v[2]) + ")";
}

std::string direction_text(const Eigen::Vector3d& d) {
  for (int a = 0; a < 3; ++a) {
    if (std::abs(d[a]) > 1 - 1e-6) return std::string(1, "xyz"[a]);
  }
  return vector_text(d);
}

// Orthonormal directions spanning the columns; the coordinate axes if they span space.
Eigen::MatrixXd span_directions(const Eigen::MatrixXd& columns) {
  if (columns.cols() == 0) return Eigen::MatrixXd(3, 0);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(columns, Eigen::ComputeThinU);
  Eigen::Index rank = 0;
  while (rank < svd.singularValues().size() && svd.singularValues()[rank] > 1e-6) ++rank;
  if (rank == 3) return Eigen::Matrix3d::Identity();
  return svd.matrixU().leftCols(rank);
}

void describe_body(const Body& body, const Eigen::MatrixXd& motions, const std::string& prefix,
                   std::vector<std::string>& text) {
  const Eigen::MatrixXd rotation = motions.bottomRows(3);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(rotation, Eigen::ComputeFullV);
  const Eigen::Index rank = (svd.singularValues().array() > 1e-6).count();
  const Eigen::Index still = motions.cols() - rank;
  const Eigen::MatrixXd translations = motions.topRows(3) * svd.matrixV().rightCols(still);
  const Eigen::MatrixXd directions = span_directions(translations);
  for (Eigen::Index i = 0; i < directions.cols(); ++i) {
    text.push_back(prefix + "translation along " + direction_text(directions.col(i)));
  }
  const Eigen::MatrixXd axes = span_directions(rotation);
  for (Eigen::Index i = 0; i < axes.cols(); ++i) {
    const Eigen::Vector3d axis = axes.col(i);
    const Eigen::VectorXd z =
        rotation.completeOrthogonalDecomposition().solve(Eigen::VectorXd(axis));
    Eigen::Vector3d velocity = body.length * (motions.topRows(3) * z);
    velocity -= directions * (directions.transpose() * velocity);
    const double pitch = velocity.dot(axis);
    const Eigen::Vector3d point = body.reference + axis.cross(velocity);
    text.push_back(prefix + (std::abs(pitch) > 1e-6 * body.length ? "screw" : "rotation") +
                   " about " + direction_text(axis) + " through " + vector_text(point));
  }
}

}  // namespace

std::vector<std::string> free_rigid_motions(const TetMesh& mesh, const Constraints& constraints) {
  const std::vector<Body> bodies = make_bodies(mesh);
  const Eigen::MatrixXd motions = free_motions(mesh, constraints, bodies);
  std::vector<std::string> text;
  if (motions.cols() == 0) return text;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Eigen::MatrixXd all = motions.middleRows(6 * static_cast<Eigen::Index>(b), 6);
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(all, Eigen::ComputeThinU);
    const Eigen::Index rank = (svd.singularValues().array() > 1e-6).count();
    if (rank == 0) continue;
    const std::string prefix = bodies.size() == 1 ? ""
                                                  : "piece " + std::to_string(b + 1) + " of " +
                                                        std::to_string(bodies.size()) + " near " +
                                                        vector_text(bodies[b].reference) + ": ";
    describe_body(bodies[b], svd.matrixU().leftCols(rank), prefix, text);
  }
  return text;
}

void require_held(const TetMesh& mesh, const Constraints& constraints) {
  const std::vector<std::string> motions = free_rigid_motions(mesh, constraints);
  if (motions.empty()) return;
  std::string text = "the supports leave the part free to move: ";
  for (std::size_t i = 0; i < motions.size(); ++i) text += (i == 0 ? "" : "; ") + motions[i];
  throw SolverError(text);
}

}  // namespace codesign::fem
