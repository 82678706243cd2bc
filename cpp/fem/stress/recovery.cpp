#include "fem/stress/recovery.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "fem/mesh/incidence.hpp"
#include "fem/mesh/tet10.hpp"
#include "interrupt.hpp"

namespace codesign::fem {

namespace {

constexpr std::size_t kMinPatch = 10;  // elements
// Weight of a point at distance r (over the patch radius): (r² + kCore)^(-exponent / 2). A small
// exponent smooths, a large one follows the nearest points.
constexpr double kCore = 0.01;
constexpr double kExponent = 3.0, kSmoothExponent = 2.0, kSharpExponent = 4.0;
// Holds the quadratic terms where a patch does not determine them.
constexpr double kRidge = 1e-10;
// A patch whose least pivot is below this share of the weights hardly determines a quadratic: it is
// given one ring more. Without it single nodes of the shipped grid overshoot, by up to 150 %.
constexpr double kLeastPivot = 1e-4;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

using Basis = Eigen::Matrix<double, 10, 1>;

using Coefficients = Eigen::Matrix<double, 10, 6>;  // of one field, a column each component
using FieldsView = Eigen::Ref<const StressFields>;  // any number of fields side by side

Basis quadratic_basis(const Eigen::Vector3d& r) {
  Basis p;
  p << 1.0, r[0], r[1], r[2], r[0] * r[0], r[1] * r[1], r[2] * r[2], r[0] * r[1], r[1] * r[2],
      r[2] * r[0];
  return p;
}

Points stress_points(const TetMesh& mesh) {
  Eigen::Matrix<double, kTetNodes, 4> values;
  for (int q = 0; q < 4; ++q) values.col(q) = tet10_values(tet_rule_4().points[at(q)]);
  Points x(4 * mesh.tets.rows(), 3);
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    x.middleRows<4>(4 * e) = (tet_nodes(mesh, e) * values).transpose();
  }
  return x;
}

bool share_side(const TetMesh& mesh, int a, int b) {
  int common = 0;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) common += mesh.tets(a, i) == mesh.tets(b, j);
  }
  return common >= 3;
}

// Collects the elements around a corner node, and their neighbors through sides as long as they
// are fewer than ten.
class PatchFinder {
 public:
  explicit PatchFinder(const TetMesh& mesh)
      : mesh_(mesh),
        incidence_(elements_of_nodes(mesh, 4)),
        seen_(at(static_cast<int>(mesh.tets.rows())), -1) {}

  bool is_corner(int node) const {
    return incidence_.start[at(node)] < incidence_.start[at(node) + 1];
  }

  const std::vector<int>& around(int node) {
    patch_.clear();
    ++number_;
    for (int j = incidence_.start[at(node)]; j < incidence_.start[at(node) + 1]; ++j) {
      add(incidence_.element[at(j)]);
    }
    core_ = patch_.size();
    rim_ = 0;
    grown_ = false;
    while (patch_.size() < kMinPatch && grow()) {
    }
    return patch_;
  }

  // Adds the neighbors of the outermost ring; false if there are none.
  bool grow() {
    const std::size_t ring = patch_.size();
    for (; rim_ < ring; ++rim_) add_neighbors(patch_[rim_]);
    return patch_.size() > ring;
  }

  // Adds a ring, unless that was done for this corner before.
  bool grow_once() { return !std::exchange(grown_, true) && grow(); }

  const std::vector<int>& patch() const { return patch_; }
  std::size_t core() const { return core_; }  // of these the first ones touch the node

 private:
  void add(int element) {
    if (seen_[at(element)] == number_) return;
    seen_[at(element)] = number_;
    patch_.push_back(element);
  }

  void add_neighbors(int element) {
    for (int k = 0; k < 4; ++k) {
      const int corner = mesh_.tets(element, k);
      for (int j = incidence_.start[at(corner)]; j < incidence_.start[at(corner) + 1]; ++j) {
        const int other = incidence_.element[at(j)];
        if (seen_[at(other)] != number_ && share_side(mesh_, element, other)) add(other);
      }
    }
  }

  const TetMesh& mesh_;
  Incidence incidence_;
  std::vector<int> seen_, patch_;  // the last patch that each element was in; elements
  int number_ = 0;                 // of the patch
  bool grown_ = false;
  std::size_t core_ = 0,
              rim_ = 0;  // elements that touch the node; whose neighbors are in the patch
};

// The quadratic term of each pair of axes in the basis, and the stress component of each.
constexpr int kQuadratic[3][3] = {{4, 7, 9}, {7, 5, 8}, {9, 8, 6}};
constexpr int kComponent[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};

// A term of a condition below: what it multiplies, and by what (of x² the second derivative is 2).
struct BalanceTerm {
  int component, quadratic;
  double factor;
};

// ∂ₖ of line i of div σ of a quadratic stress, k and i in `condition`: its three terms.
std::array<BalanceTerm, 3> balance_terms(int condition) {
  const int i = condition / 3, k = condition % 3;
  std::array<BalanceTerm, 3> terms;
  for (int j = 0; j < 3; ++j) {
    terms[at(j)] = {kComponent[i][j], kQuadratic[j][k], j == k ? 2.0 : 1.0};
  }
  return terms;
}

// Moves fits to the nearest ones, in the norm of their least squares (shears count twice, as they
// stand in the tensor: the result turns with the axes), with one body force over the whole patch:
// the derivative of div σ vanishes, nine conditions on the quadratic terms of a field. At edges of
// the body, where a fit sees one side only, they replace what it does not see.
void balance(const Eigen::LDLT<Eigen::Matrix<double, 10, 10>>& factor,
             std::vector<Coefficients>& fields) {
  static const std::array<std::array<BalanceTerm, 3>, 9> terms = [] {
    std::array<std::array<BalanceTerm, 3>, 9> all;
    for (int c = 0; c < 9; ++c) all[at(c)] = balance_terms(c);
    return all;
  }();
  const auto weight = [](int component) { return component < 3 ? 1.0 : 2.0; };
  Eigen::Matrix<double, 10, 6> quadratic = Eigen::Matrix<double, 10, 6>::Zero();
  quadratic.bottomRows<6>().setIdentity();
  const Eigen::Matrix<double, 10, 6> moves = factor.solve(quadratic);  // of the inverse
  Eigen::Matrix<double, 9, 9> conditions = Eigen::Matrix<double, 9, 9>::Zero();
  for (int a = 0; a < 9; ++a) {
    for (int b = 0; b <= a; ++b) {
      for (const BalanceTerm& p : terms[at(a)]) {
        for (const BalanceTerm& q : terms[at(b)]) {
          if (p.component != q.component) continue;
          conditions(a, b) +=
              p.factor * q.factor * moves(p.quadratic, q.quadratic - 4) / weight(p.component);
        }
      }
      conditions(b, a) = conditions(a, b);
    }
  }
  const Eigen::LDLT<Eigen::Matrix<double, 9, 9>> solver(conditions);
  for (Coefficients& coefficients : fields) {
    Eigen::Matrix<double, 9, 1> missed = Eigen::Matrix<double, 9, 1>::Zero();
    for (int c = 0; c < 9; ++c) {
      for (const BalanceTerm& t : terms[at(c)]) {
        missed[c] += t.factor * coefficients(t.quadratic, t.component);
      }
    }
    const Eigen::Matrix<double, 9, 1> multipliers = solver.solve(missed);
    for (int c = 0; c < 9; ++c) {
      for (const BalanceTerm& t : terms[at(c)]) {
        coefficients.col(t.component) -=
            t.factor * multipliers[c] / weight(t.component) * moves.col(t.quadratic - 4);
      }
    }
  }
}

// Quadratic stresses around a corner node.
struct PatchField {
  Eigen::Vector3d origin;
  double radius = 0.0;
  bool balanced = false;  // fits fulfill equilibrium, see balance()
  std::vector<Coefficients> coefficients = {};
  double least_pivot = 0.0;  // over the sum of the weights

  Eigen::Matrix<double, 1, 6> at(const Eigen::Vector3d& x, std::size_t field) const {
    return quadratic_basis((x - origin) / radius).transpose() * coefficients[field];
  }
};

double weight(double squared_distance, double exponent) {
  const double s = squared_distance + kCore;
  return exponent == kExponent ? 1.0 / (s * std::sqrt(s)) : std::pow(s, -0.5 * exponent);
}

// Weighted least-squares fits around the field's origin, coordinates divided by its radius.
void fit(const std::vector<int>& patch, const Points& x, const FieldsView& stress, double exponent,
         PatchField& field) {
  Eigen::Matrix<double, 10, 10> normal = Eigen::Matrix<double, 10, 10>::Zero();
  std::vector<Coefficients>& right = field.coefficients;
  right.assign(static_cast<std::size_t>(stress.cols() / 6), Coefficients::Zero());
  double total = 0.0;
  for (const int e : patch) {
    for (int q = 4 * e; q < 4 * e + 4; ++q) {
      const Eigen::Vector3d r = (x.row(q).transpose() - field.origin) / field.radius;
      const double w = weight(r.squaredNorm(), exponent);
      const Basis p = quadratic_basis(r);
      const Basis wp = w * p;
      total += w;
      normal.noalias() += wp * p.transpose();
      for (std::size_t f = 0; f < right.size(); ++f)
        right[f].noalias() += wp * stress.block<1, 6>(q, 6 * static_cast<Eigen::Index>(f));
    }
  }
  if (patch.size() < kMinPatch) {  // a mesh of a few elements: the quadratic terms stay zero
    const Eigen::LDLT<Eigen::Matrix4d> factor(normal.topLeftCorner<4, 4>());
    for (Coefficients& coefficients : right) {
      coefficients.topRows<4>() = factor.solve(coefficients.topRows<4>()).eval();
      coefficients.bottomRows<6>().setZero();
    }
    field.least_pivot = 1.0;
    return;
  }
  normal.diagonal().segment<3>(4).array() += kRidge * total;
  normal.diagonal().tail<3>().array() += 0.5 * kRidge * total;  // the same in turned axes
  const Eigen::LDLT<Eigen::Matrix<double, 10, 10>> factor(normal);
  for (Coefficients& coefficients : right) coefficients = factor.solve(coefficients).eval();
  if (field.balanced) balance(factor, field.coefficients);
  field.least_pivot = factor.vectorD().minCoeff() / total;
}

double patch_radius(const TetMesh& mesh, const std::vector<int>& patch,
                    const Eigen::Vector3d& origin) {
  double radius = 0.0;
  for (const int e : patch) {
    for (int i = 0; i < 4; ++i) {
      radius = std::max(radius, (mesh.nodes.row(mesh.tets(e, i)).transpose() - origin).norm());
    }
  }
  return radius;
}

// The fields around a corner, on a patch that determines them.
PatchField fit_around(const TetMesh& mesh, int corner, BodyPlace place, PatchFinder& finder,
                      const Points& x, const FieldsView& stress) {
  const std::vector<int>& patch = finder.around(corner);
  PatchField field{mesh.nodes.row(corner).transpose()};
  field.balanced = place == BodyPlace::edge;
  do {
    field.radius = patch_radius(mesh, patch, field.origin);
    fit(patch, x, stress, kExponent, field);
  } while (field.least_pivot < kLeastPivot && finder.grow_once());
  return field;
}

}  // namespace

StressFields recover_fields(const TetMesh& mesh, const std::vector<BodyPlace>& places,
                            const Eigen::Ref<const StressFields>& points) {
  const Points x = stress_points(mesh);
  PatchFinder finder(mesh);
  const int nodes = static_cast<int>(mesh.nodes.rows());
  const auto fields = static_cast<std::size_t>(points.cols() / 6);
  StressFields sum = StressFields::Zero(nodes, points.cols());
  const auto of_field = [&](int node, std::size_t f) {
    return sum.block<1, 6>(node, 6 * static_cast<Eigen::Index>(f));
  };
  std::vector<int> count(at(nodes), 0), seen_from(at(nodes), -1);
  for (int v = 0; v < nodes; ++v) {
    check_interrupt();
    if (!finder.is_corner(v)) continue;
    const PatchField field = fit_around(mesh, v, places[at(v)], finder, x, points);
    for (std::size_t f = 0; f < fields; ++f) of_field(v, f) += field.coefficients[f].row(0);
    ++count[at(v)];
    for (std::size_t i = 0; i < finder.core(); ++i) {
      for (int k = 0; k < 6; ++k) {
        const int e = finder.patch()[i], middle = mesh.tets(e, 4 + k);
        const bool on_edge =
            mesh.tets(e, kTetEdges[k][0]) == v || mesh.tets(e, kTetEdges[k][1]) == v;
        if (!on_edge || seen_from[at(middle)] == v) continue;
        seen_from[at(middle)] = v;
        const Eigen::Vector3d place = mesh.nodes.row(middle).transpose();
        for (std::size_t f = 0; f < fields; ++f) of_field(middle, f) += field.at(place, f);
        ++count[at(middle)];
      }
    }
  }
  for (int n = 0; n < nodes; ++n) {
    if (count[at(n)] > 1) sum.row(n) /= count[at(n)];
  }
  return sum;
}

Stresses recover_stress(const TetMesh& mesh, const std::vector<BodyPlace>& places,
                        const PointStresses& points) {
  return recover_fields(mesh, places, points.stress);
}

double recovery_spread(const TetMesh& mesh, const std::vector<BodyPlace>& places,
                       const PointStresses& points, int triangle,
                       const Eigen::Vector2d& reference) {
  const Points x = stress_points(mesh);
  PatchFinder finder(mesh);
  const FaceNodes nodes = face_nodes(mesh, triangle);
  Eigen::Matrix<double, 6, 6> smooth = Eigen::Matrix<double, 6, 6>::Zero(), sharp = smooth;
  for (int k = 0; k < 3; ++k) {
    const int corner = mesh.boundary(triangle, k);
    PatchField field = fit_around(mesh, corner, places[at(corner)], finder, x, points.stress);
    for (auto& [stress, exponent] :
         {std::pair(&smooth, kSmoothExponent), {&sharp, kSharpExponent}}) {
      fit(finder.patch(), x, points.stress, exponent, field);
      stress->row(k) += field.at(nodes.col(k), 0);
      stress->row(3 + k) += 0.5 * field.at(nodes.col(3 + k), 0);
      stress->row(3 + (k + 2) % 3) += 0.5 * field.at(nodes.col(3 + (k + 2) % 3), 0);
    }
  }
  const Eigen::Matrix<double, 6, 1> values = tri6_values(reference);
  return std::abs(von_mises(Voigt(sharp.transpose() * values)) -
                  von_mises(Voigt(smooth.transpose() * values)));
}

double recovery_spread_inside(const TetMesh& mesh, const std::vector<BodyPlace>& places,
                              const PointStresses& points, int element,
                              const Eigen::Vector3d& position) {
  const Points x = stress_points(mesh);
  PatchFinder finder(mesh);
  Voigt smooth = Voigt::Zero(), sharp = smooth;
  for (int k = 0; k < 4; ++k) {
    const int corner = mesh.tets(element, k);
    PatchField field = fit_around(mesh, corner, places[at(corner)], finder, x, points.stress);
    for (auto& [stress, exponent] :
         {std::pair(&smooth, kSmoothExponent), {&sharp, kSharpExponent}}) {
      fit(finder.patch(), x, points.stress, exponent, field);
      *stress += 0.25 * field.at(position, 0).transpose();
    }
  }
  return std::abs(von_mises(sharp) - von_mises(smooth));
}

RecoveryError recovery_error(const TetMesh& mesh, const Material& material,
                             const Eigen::VectorXd& displacement, const Stresses& recovered) {
  const double lambda = lame_lambda(material), mu = shear_modulus(material);
  const double young = material.young_modulus, nu = material.poisson_ratio;
  // Twice the energy density of a stress.
  const auto energy = [&](const Voigt& s) {
    const double trace = s[0] + s[1] + s[2];
    return ((1 + nu) * (s.head<3>().squaredNorm() + 2.0 * s.tail<3>().squaredNorm()) -
            nu * trace * trace) /
           young;
  };
  const TetRule& rule = tet_rule_14();
  std::vector<TetValues> values;
  for (const Eigen::Vector3d& p : rule.points) values.push_back(tet10_values(p));
  RecoveryError error;
  error.element.resize(mesh.tets.rows());
  double difference_energy = 0.0, total_energy = 0.0;
  TetPoints points;
  TetNodes u;
  Eigen::Matrix<double, kTetNodes, 6> nodal;
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    check_interrupt();
    evaluate_tet(tet_nodes(mesh, e), rule, points);
    for (int i = 0; i < kTetNodes; ++i) {
      u.col(i) = displacement.segment<3>(3 * mesh.tets(e, i));
      nodal.row(i) = recovered.row(mesh.tets(e, i));
    }
    double volume = 0.0, square = 0.0;
    for (int q = 0; q < points.count; ++q) {
      const Voigt smooth = nodal.transpose() * values[at(q)];
      const Voigt raw = stress_of_gradient(lambda, mu, u * points.gradients[at(q)].transpose());
      const double mises = von_mises(Voigt(smooth - raw)), weight = points.weights[at(q)];
      volume += weight;
      square += weight * mises * mises;
      difference_energy += weight * energy(smooth - raw);
      total_energy += weight * energy(smooth);
    }
    error.element[e] = std::sqrt(std::max(0.0, square / volume));
  }
  if (total_energy > 0) error.relative_energy = std::sqrt(difference_energy / total_energy);
  return error;
}

}  // namespace codesign::fem
