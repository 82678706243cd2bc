#include "fem/elasticity/substructure.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "errors.hpp"
#include "fem/elasticity/stiffness.hpp"
#include "fem/mesh/tet10.hpp"

namespace codesign::fem {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

TetMesh chosen_elements(const TetMesh& mesh, const std::vector<char>& elements) {
  TetMesh chosen;
  chosen.nodes = mesh.nodes;
  std::vector<int> rows;
  for (std::size_t e = 0; e < elements.size(); ++e)
    if (elements[e]) rows.push_back(static_cast<int>(e));
  chosen.tets = mesh.tets(rows, Eigen::all);
  return chosen;
}

std::vector<char> nodes_of(const TetMesh& mesh) {
  std::vector<char> used(at(static_cast<int>(mesh.nodes.rows())), 0);
  for (int e = 0; e < mesh.tets.rows(); ++e)
    for (int i = 0; i < kTetNodes; ++i) used[at(mesh.tets(e, i))] = 1;
  return used;
}

// Nodes without an element here are held.
Constraints among(const Constraints& constraints, const TetMesh& elements) {
  Constraints inside = constraints;
  const std::vector<char> used = nodes_of(elements);
  for (std::size_t d = 0; d < inside.fixed.size(); ++d)
    if (!used[d / 3]) inside.fixed[d] = 1;
  return inside;
}

NodePattern order_with_last(const TetMesh& elements, const Constraints& inside,
                            const std::vector<int>& last) {
  std::vector<char> flags(at(static_cast<int>(elements.nodes.rows())), 0);
  for (const int node : last) flags[at(node)] = 1;
  return order_nodes(elements, inside, VertexOrdering::automatic, flags);
}

std::vector<int> free_components(const Constraints& constraints, const std::vector<int>& nodes) {
  std::vector<int> components;
  for (const int node : nodes)
    for (int d = 3 * node; d < 3 * node + 3; ++d)
      if (!constraints.fixed[at(d)]) components.push_back(d);
  return components;
}

Eigen::VectorXd gather(const NodePattern& pattern, const Eigen::VectorXd& nodal) {
  Eigen::VectorXd values(pattern.equations());
  for (std::size_t d = 0; d < pattern.equation.size(); ++d)
    if (pattern.equation[d] >= 0) values[pattern.equation[d]] = nodal[static_cast<int>(d)];
  return values;
}

void scatter(const NodePattern& pattern, const Eigen::VectorXd& values, Eigen::VectorXd& nodal) {
  for (std::size_t d = 0; d < pattern.equation.size(); ++d)
    if (pattern.equation[d] >= 0) nodal[static_cast<int>(d)] = values[pattern.equation[d]];
}

// Adds a full symmetric matrix between equations that the pattern couples.
void add_full(const Eigen::MatrixXd& full, const std::vector<int>& equations, LowerMatrix& matrix) {
  for (Eigen::Index j = 0; j < full.cols(); ++j) {
    const int column = equations[static_cast<std::size_t>(j)];
    const auto first = matrix.row.begin() + matrix.start[at(column)];
    const auto end = matrix.row.begin() + matrix.start[at(column) + 1];
    for (Eigen::Index i = 0; i < full.rows(); ++i) {
      const int row = equations[static_cast<std::size_t>(i)];
      if (row < column) continue;
      const auto place = std::lower_bound(first, end, row) - matrix.row.begin();
      matrix.value[static_cast<std::size_t>(place)] += full(i, j);
    }
  }
}

std::vector<int> equations_of(const NodePattern& pattern, const std::vector<int>& components) {
  std::vector<int> equations;
  equations.reserve(components.size());
  for (const int component : components) equations.push_back(pattern.equation[at(component)]);
  return equations;
}

}  // namespace

// The shared nodes come last in the factor, so its corner there is the factor of their Schur
// complement. A piece that only they hold is singular without a stiffness of theirs: they get their
// own diagonal once more, which is taken off the product.
Substructure::Substructure(const TetMesh& mesh, const std::vector<char>& elements,
                           const Material& material, const Constraints& constraints,
                           const std::vector<int>& shared, const FactorLimits& limits) {
  const TetMesh chosen = chosen_elements(mesh, elements);
  const Constraints inside = among(constraints, chosen);
  pattern_ = order_with_last(chosen, inside, shared);
  if (!factor_fits(pattern_, limits))
    throw MemoryLimitError("the factor of a piece of the part is larger than its limits");
  LowerMatrix matrix = assemble_stiffness(chosen, material, pattern_);
  const std::vector<int> equation = equations_of(pattern_, free_components(inside, shared));
  rank_.resize(equation.size());
  std::iota(rank_.begin(), rank_.end(), 0);
  std::sort(rank_.begin(), rank_.end(),
            [&](int a, int b) { return equation[at(a)] < equation[at(b)]; });
  Eigen::VectorXd added(static_cast<Eigen::Index>(rank_.size()));
  for (const int k : rank_) {
    double& diagonal = matrix.value[at(matrix.start[at(equation[at(k)])])];
    added[static_cast<Eigen::Index>(equations_.size())] = diagonal;
    diagonal *= 2.0;
    equations_.push_back(equation[at(k)]);
  }
  factor_ = std::make_unique<CholeskyFactor>(pattern_, matrix);
  corner_ = factor_->block(equations_);
  Eigen::MatrixXd complement = Eigen::MatrixXd::Zero(corner_.rows(), corner_.cols());
  complement.selfadjointView<Eigen::Lower>().rankUpdate(corner_);
  complement.diagonal() -= added;
  stiffness_.resize(complement.rows(), complement.cols());
  stiffness_(rank_, rank_) = complement.selfadjointView<Eigen::Lower>().toDenseMatrix();
}

double Substructure::bytes() const {
  const double dense = static_cast<double>(corner_.size() + stiffness_.size());
  const double indices = static_cast<double>(pattern_.neighbor.size() + pattern_.equation.size());
  return sizeof(double) * (factor_->nonzeros() + dense) + sizeof(int) * indices;
}

double Substructure::operations() const { return pattern_.supernodes.operations; }

Substructure::Condensed Substructure::condense(const Eigen::VectorXd& load) const {
  Eigen::VectorXd forces = gather(pattern_, load);
  forces(equations_).setZero();
  Condensed result{factor_->solve_lower(forces), Eigen::VectorXd(stiffness_.rows())};
  result.shared(rank_) = corner_.triangularView<Eigen::Lower>() * result.inner(equations_);
  return result;
}

void Substructure::expand(Condensed condensed, Eigen::VectorXd& u) const {
  const Eigen::VectorXd shared = gather(pattern_, u)(equations_);
  condensed.inner(equations_) = corner_.transpose().triangularView<Eigen::Upper>() * shared;
  Eigen::VectorXd solution = factor_->solve_upper(condensed.inner);
  solution(equations_) = shared;
  scatter(pattern_, solution, u);
}

std::shared_ptr<const KeptElements> keep_elements(const TetMesh& mesh, std::vector<char> reshaped,
                                                  const Material& material,
                                                  const Constraints& constraints,
                                                  const FactorLimits& limits) {
  std::vector<char> others(reshaped.size());
  std::transform(reshaped.begin(), reshaped.end(), others.begin(), [](char c) { return !c; });
  const TetMesh chosen = chosen_elements(mesh, reshaped);
  const std::vector<char> in_reshaped = nodes_of(chosen);
  const std::vector<char> in_others = nodes_of(chosen_elements(mesh, others));
  std::vector<int> shared;
  for (std::size_t n = 0; n < in_others.size(); ++n)
    if (in_reshaped[n] && in_others[n]) shared.push_back(static_cast<int>(n));
  auto kept = std::make_shared<KeptElements>();
  kept->rest =
      std::make_unique<const Substructure>(mesh, others, material, constraints, shared, limits);
  kept->pattern = order_with_last(chosen, among(constraints, chosen), shared);
  kept->components = free_components(constraints, shared);
  kept->reshaped = std::move(reshaped);
  return kept;
}

CondensedFactor::CondensedFactor(std::shared_ptr<const KeptElements> kept, const TetMesh& mesh,
                                 const Material& material)
    : kept_(std::move(kept)) {
  const NodePattern& pattern = kept_->pattern;
  LowerMatrix matrix =
      assemble_stiffness(chosen_elements(mesh, kept_->reshaped), material, pattern);
  add_full(kept_->rest->stiffness(), equations_of(pattern, kept_->components), matrix);
  factor_ = std::make_unique<CholeskyFactor>(pattern, matrix);
}

Eigen::VectorXd CondensedFactor::solve(const Eigen::VectorXd& load) const {
  Substructure::Condensed rest = kept_->rest->condense(load);
  Eigen::VectorXd forces = load;
  forces(kept_->components) += rest.shared;
  Eigen::VectorXd u = Eigen::VectorXd::Zero(load.size());
  scatter(kept_->pattern, factor_->solve(gather(kept_->pattern, forces)), u);
  kept_->rest->expand(std::move(rest), u);
  return u;
}

}  // namespace codesign::fem
