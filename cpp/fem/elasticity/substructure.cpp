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

// The elements that are not among the given ones, in groups that hang together by nodes.
std::vector<TetMesh> groups_of_others(const TetMesh& mesh, const std::vector<char>& given) {
  std::vector<int> leader(at(static_cast<int>(mesh.nodes.rows())));
  std::iota(leader.begin(), leader.end(), 0);
  const auto find = [&](int node) {
    while (leader[at(node)] != node) node = leader[at(node)] = leader[at(leader[at(node)])];
    return node;
  };
  for (int e = 0; e < mesh.tets.rows(); ++e)
    for (int i = 1; i < kTetNodes && !given[at(e)]; ++i)
      leader[at(find(mesh.tets(e, i)))] = find(mesh.tets(e, 0));
  std::vector<int> group_of(leader.size(), -1);
  std::vector<std::vector<char>> groups;
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    if (given[at(e)]) continue;
    int& group = group_of[at(find(mesh.tets(e, 0)))];
    if (group < 0) {
      group = static_cast<int>(groups.size());
      groups.emplace_back(given.size(), 0);
    }
    groups[at(group)][at(e)] = 1;
  }
  std::vector<TetMesh> pieces;
  for (const std::vector<char>& elements : groups)
    pieces.push_back(chosen_elements(mesh, elements));
  return pieces;
}

std::vector<int> shared_nodes(const std::vector<char>& some, const std::vector<char>& others) {
  std::vector<int> shared;
  for (std::size_t n = 0; n < some.size(); ++n)
    if (some[n] && others[n]) shared.push_back(static_cast<int>(n));
  return shared;
}

std::vector<int> free_components(const Constraints& constraints, const std::vector<int>& nodes) {
  std::vector<int> components;
  for (const int node : nodes)
    for (int d = 3 * node; d < 3 * node + 3; ++d)
      if (!constraints.fixed[at(d)]) components.push_back(d);
  return components;
}

int count_free(const Constraints& constraints, const std::vector<int>& nodes) {
  return static_cast<int>(free_components(constraints, nodes).size());
}

Eigen::MatrixXf gather(const NodePattern& pattern, const Eigen::MatrixXd& nodal) {
  Eigen::MatrixXf values(pattern.equations(), nodal.cols());
  for (Eigen::Index k = 0; k < nodal.cols(); ++k)
    for (std::size_t d = 0; d < pattern.equation.size(); ++d)
      if (pattern.equation[d] >= 0)
        values(pattern.equation[d], k) = static_cast<float>(nodal(static_cast<int>(d), k));
  return values;
}

void scatter(const NodePattern& pattern, const Eigen::MatrixXf& values, Eigen::MatrixXd& nodal) {
  for (Eigen::Index k = 0; k < nodal.cols(); ++k)
    for (std::size_t d = 0; d < pattern.equation.size(); ++d)
      if (pattern.equation[d] >= 0) nodal(static_cast<int>(d), k) = values(pattern.equation[d], k);
}

// The pattern of elements whose shared nodes come last.
NodePattern order_piece(const TetMesh& piece, const Constraints& constraints,
                        const std::vector<int>& shared, const FactorLimits& limits) {
  NodePattern pattern =
      order_nodes(piece, among(constraints, piece), VertexOrdering::automatic, {{shared}, true});
  if (!factor_fits(pattern, limits))
    throw MemoryLimitError("the factor of a piece of the part is larger than its limits");
  return pattern;
}

SingleFactor factorize_reshaped(const KeptElements& kept, const TetMesh& mesh,
                                const Material& material) {
  std::vector<DenseBlock> blocks;
  for (const KeptElements::Piece& piece : kept.pieces) {
    std::vector<int> equations;
    for (const int component : piece.components)
      equations.push_back(kept.pattern.equation[at(component)]);
    blocks.push_back({piece.elements.stiffness(), std::move(equations)});
  }
  const LowerMatrix matrix =
      assemble_stiffness(chosen_elements(mesh, kept.reshaped), material, kept.pattern);
  return {kept.pattern, matrix, 0, blocks};
}

}  // namespace

Substructure::Substructure(const TetMesh& piece, const Material& material,
                           const Constraints& constraints, const std::vector<int>& shared,
                           const FactorLimits& limits)
    : pattern_(order_piece(piece, constraints, shared, limits)),
      factor_(pattern_, assemble_stiffness(piece, material, pattern_),
              count_free(constraints, shared)) {}

double Substructure::bytes() const {
  const double indices = static_cast<double>(pattern_.neighbor.size() + pattern_.equation.size());
  return factor_.bytes() + sizeof(int) * indices;
}

double Substructure::operations() const { return pattern_.supernodes.operations; }

Eigen::MatrixXf Substructure::condense(const Eigen::MatrixXd& loads) const {
  Eigen::MatrixXf forces = gather(pattern_, loads);
  forces.bottomRows(stiffness().rows()).setZero();
  factor_.solve_lower(forces);
  return forces;
}

void Substructure::expand(Eigen::MatrixXf condensed, Eigen::MatrixXd& u) const {
  const Eigen::Index shared = stiffness().rows();
  condensed.bottomRows(shared) = gather(pattern_, u).bottomRows(shared);
  factor_.solve_upper(condensed);
  scatter(pattern_, condensed, u);
}

double KeptElements::bytes() const {
  return std::accumulate(pieces.begin(), pieces.end(), 0.0, [](double sum, const Piece& piece) {
    return sum + piece.elements.bytes();
  });
}

double KeptElements::operations() const {
  return std::accumulate(pieces.begin(), pieces.end(), 0.0, [](double sum, const Piece& piece) {
    return sum + piece.elements.operations();
  });
}

std::shared_ptr<const KeptElements> keep_elements(const TetMesh& mesh, std::vector<char> reshaped,
                                                  const Material& material,
                                                  const Constraints& constraints,
                                                  const FactorLimits& limits) {
  const TetMesh chosen = chosen_elements(mesh, reshaped);
  const std::vector<char> in_reshaped = nodes_of(chosen);
  const std::vector<TetMesh> others = groups_of_others(mesh, reshaped);
  CoupledNodes coupled;
  for (const TetMesh& piece : others)
    coupled.groups.push_back(shared_nodes(in_reshaped, nodes_of(piece)));
  auto kept = std::make_shared<KeptElements>();
  kept->pattern =
      order_nodes(chosen, among(constraints, chosen), VertexOrdering::automatic, coupled);
  for (std::size_t p = 0; p < others.size(); ++p) {
    std::vector<int>& shared = coupled.groups[p];
    std::sort(shared.begin(), shared.end(), [&](int a, int b) {
      return kept->pattern.position[at(a)] < kept->pattern.position[at(b)];
    });
    kept->pieces.push_back(
        {{others[p], material, constraints, shared, limits}, free_components(constraints, shared)});
  }
  kept->reshaped = std::move(reshaped);
  return kept;
}

CondensedFactor::CondensedFactor(std::shared_ptr<const KeptElements> kept, const TetMesh& mesh,
                                 const Material& material)
    : kept_(std::move(kept)), factor_(factorize_reshaped(*kept_, mesh, material)) {}

Eigen::MatrixXd CondensedFactor::solve(const Eigen::MatrixXd& loads) const {
  Eigen::MatrixXd forces = loads;
  std::vector<Eigen::MatrixXf> condensed;
  for (const KeptElements::Piece& piece : kept_->pieces) {
    condensed.push_back(piece.elements.condense(loads));
    const auto shared = static_cast<Eigen::Index>(piece.components.size());
    forces(piece.components, Eigen::all) += condensed.back().bottomRows(shared).cast<double>();
  }
  Eigen::MatrixXf solution = gather(kept_->pattern, forces);
  factor_.solve_lower(solution);
  factor_.solve_upper(solution);
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(loads.rows(), loads.cols());
  scatter(kept_->pattern, solution, u);
  for (std::size_t p = 0; p < kept_->pieces.size(); ++p)
    kept_->pieces[p].elements.expand(std::move(condensed[p]), u);
  return u;
}

}  // namespace codesign::fem
