#include "fem/la/ordering.hpp"

#include <cholmod.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "errors.hpp"
#include "fem/mesh/incidence.hpp"
#include "fem/mesh/tet10.hpp"

namespace codesign::fem {

namespace {

// Above this number of corner vertices nested dissection needs fewer operations in total.
constexpr int kDissectionVertices = 3000;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

bool has_free_component(const Constraints& c, int node) {
  const std::size_t d = 3 * at(node);
  return !c.fixed[d] || !c.fixed[d + 1] || !c.fixed[d + 2];
}

// Permutation of a symmetric graph given as compressed rows: AMD or METIS of CHOLMOD.
std::vector<int> order_graph(std::vector<int>& start, std::vector<int>& column, bool dissection) {
  const std::size_t n = start.size() - 1;
  std::vector<int> permutation(n);
  if (n == 0) return permutation;
  cholmod_common common;
  cholmod_start(&common);
  common.print = 0;
  cholmod_sparse graph{};
  graph.nrow = graph.ncol = n;
  graph.nzmax = column.size();
  graph.p = start.data();
  graph.i = column.data();
  graph.stype = -1;  // each edge once, in the lower triangle
  graph.itype = CHOLMOD_INT;
  graph.xtype = CHOLMOD_PATTERN;
  graph.packed = 1;
  const int ok = dissection ? cholmod_metis(&graph, nullptr, 0, 1, permutation.data(), &common)
                            : cholmod_amd(&graph, nullptr, 0, permutation.data(), &common);
  cholmod_finish(&common);
  if (!ok) throw SolverError("out of memory while ordering the mesh nodes");
  return permutation;
}

// Which nodes are coupled.
class Groups {
 public:
  Groups(const CoupledNodes& coupled, Eigen::Index nodes)
      : coupled_(coupled), group_(static_cast<std::size_t>(nodes), -1), rank_(group_) {
    int rank = 0;
    for (std::size_t g = 0; g < coupled.groups.size(); ++g)
      for (const int node : coupled.groups[g]) {
        group_[at(node)] = static_cast<int>(g);
        if (coupled.last) rank_[at(node)] = rank++;
      }
  }

  bool is_last(int node) const { return rank_[at(node)] >= 0; }

  // Place among those that are last; -1: another node.
  int rank(int node) const { return rank_[at(node)]; }

  // Those that the node is coupled with, itself among them.
  const std::vector<int>& with(int node) const {
    static const std::vector<int> none;
    return group_[at(node)] < 0 ? none : coupled_.groups[at(group_[at(node)])];
  }

 private:
  const CoupledNodes& coupled_;
  std::vector<int> group_, rank_;  // (n) -1: none
};

// Rank of each free corner vertex in a fill-reducing order of the vertex graph; -1 for others.
// Vertices that are to be last share the highest rank.
std::vector<int> vertex_ranks(const TetMesh& mesh, const Constraints& constraints,
                              const Groups& groups, VertexOrdering method) {
  const Incidence elements = elements_of_nodes(mesh, 4);
  const int nodes = static_cast<int>(mesh.nodes.rows());
  std::vector<int> index(at(nodes), -1), vertex;
  for (int v = 0; v < nodes; ++v) {
    if (elements.start[at(v)] == elements.start[at(v) + 1] || !has_free_component(constraints, v))
      continue;
    if (groups.is_last(v)) continue;
    index[at(v)] = static_cast<int>(vertex.size());
    vertex.push_back(v);
  }
  std::vector<int> start{0}, column, seen(vertex.size(), -1);
  for (std::size_t k = 0; k < vertex.size(); ++k) {
    const int v = vertex[k];
    const auto add = [&](int node) {
      const int other = index[at(node)];
      if (other <= static_cast<int>(k) || seen[at(other)] == static_cast<int>(k)) return;
      seen[at(other)] = static_cast<int>(k);
      column.push_back(other);
    };
    for (int j = elements.start[at(v)]; j < elements.start[at(v) + 1]; ++j)
      for (int i = 0; i < 4; ++i) add(mesh.tets(elements.element[at(j)], i));
    for (const int node : groups.with(v)) add(node);
    start.push_back(static_cast<int>(column.size()));
  }
  const bool dissection = method == VertexOrdering::automatic
                              ? static_cast<int>(vertex.size()) > kDissectionVertices
                              : method == VertexOrdering::nested_dissection;
  const std::vector<int> permutation = order_graph(start, column, dissection);
  std::vector<int> rank(at(nodes), -1);
  for (std::size_t k = 0; k < permutation.size(); ++k) {
    rank[at(vertex[at(permutation[k])])] = static_cast<int>(k);
  }
  for (int v = 0; v < nodes; ++v) {
    const bool used = elements.start[at(v)] != elements.start[at(v) + 1];
    if (used && groups.is_last(v) && has_free_component(constraints, v))
      rank[at(v)] = static_cast<int>(vertex.size());
  }
  return rank;
}

// Sort key of every node: twice the rank of a vertex; a mid-edge node comes one before the earlier
// of its ends. If both ends are held, the vertices around the edge take their place.
std::vector<int> node_keys(const TetMesh& mesh, const std::vector<int>& rank) {
  constexpr int kNone = std::numeric_limits<int>::max();
  const auto earlier = [&](int a, int b) {
    const int ra = rank[at(a)] < 0 ? kNone : rank[at(a)];
    const int rb = rank[at(b)] < 0 ? kNone : rank[at(b)];
    return std::min(ra, rb);
  };
  std::vector<int> key(rank.size(), kNone);
  for (std::size_t v = 0; v < rank.size(); ++v) {
    if (rank[v] >= 0) key[v] = 2 * rank[v] + 1;
  }
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    const int around = std::min(earlier(mesh.tets(e, 0), mesh.tets(e, 1)),
                                earlier(mesh.tets(e, 2), mesh.tets(e, 3)));
    for (int k = 0; k < 6; ++k) {
      int r = earlier(mesh.tets(e, kTetEdges[k][0]), mesh.tets(e, kTetEdges[k][1]));
      if (r == kNone) r = around;
      int& mid = key[at(mesh.tets(e, 4 + k))];
      if (r != kNone) mid = std::min(mid, 2 * r);
    }
  }
  return key;
}

std::vector<int> free_components(const Constraints& constraints, const std::vector<int>& nodes) {
  std::vector<int> count;
  count.reserve(nodes.size());
  for (const int node : nodes) {
    const std::size_t d = 3 * at(node);
    count.push_back(!constraints.fixed[d] + !constraints.fixed[d + 1] + !constraints.fixed[d + 2]);
  }
  return count;
}

void number_equations(const Constraints& constraints, NodePattern& pattern) {
  pattern.equation.assign(constraints.fixed.size(), -1);
  pattern.dof_start.assign(1, 0);
  int next = 0;
  for (const int node : pattern.order) {
    for (std::size_t d = 3 * at(node); d < 3 * at(node) + 3; ++d) {
      if (!constraints.fixed[d]) pattern.equation[d] = next++;
    }
    pattern.dof_start.push_back(next);
  }
}

void set_positions(std::size_t nodes, NodePattern& pattern) {
  pattern.position.assign(nodes, -1);
  for (std::size_t k = 0; k < pattern.order.size(); ++k) {
    pattern.position[at(pattern.order[k])] = static_cast<int>(k);
  }
}

void find_neighbors(const TetMesh& mesh, const Incidence& elements, const Groups& groups,
                    NodePattern& pattern) {
  std::vector<int> seen(pattern.order.size(), -1);
  pattern.start.assign(1, 0);
  pattern.neighbor.clear();
  for (int k = 0; k < pattern.positions(); ++k) {
    const int node = pattern.order[at(k)];
    const auto add = [&](int position) {
      if (position <= k || seen[at(position)] == k) return;
      seen[at(position)] = k;
      pattern.neighbor.push_back(position);
    };
    for (int j = elements.start[at(node)]; j < elements.start[at(node) + 1]; ++j) {
      const int* tet = mesh.tets.row(elements.element[at(j)]).data();
      for (int i = 0; i < kTetNodes; ++i) add(pattern.position[at(tet[i])]);
    }
    for (const int other : groups.with(node)) add(pattern.position[at(other)]);
    std::sort(pattern.neighbor.begin() + pattern.start.back(), pattern.neighbor.end());
    pattern.start.push_back(static_cast<int>(pattern.neighbor.size()));
  }
}

// Positions, neighbors and equations of nodes in their order.
void number(const TetMesh& mesh, const Constraints& constraints, const Groups& groups,
            NodePattern& pattern) {
  set_positions(at(static_cast<int>(mesh.nodes.rows())), pattern);
  find_neighbors(mesh, elements_of_nodes(mesh, kTetNodes), groups, pattern);
  number_equations(constraints, pattern);
}

}  // namespace

NodePattern fill_reducing_order(const TetMesh& mesh, const Constraints& constraints,
                                VertexOrdering method, const CoupledNodes& coupled) {
  const Groups groups(coupled, mesh.nodes.rows());
  const std::vector<int> key = node_keys(mesh, vertex_ranks(mesh, constraints, groups, method));
  NodePattern pattern;
  for (int v = 0; v < mesh.nodes.rows(); ++v) {
    if (has_free_component(constraints, v)) pattern.order.push_back(v);
  }
  std::stable_sort(pattern.order.begin(), pattern.order.end(), [&](int a, int b) {
    const int last_a = groups.rank(a), last_b = groups.rank(b);
    return last_a < 0 && last_b < 0 ? key[at(a)] < key[at(b)] : last_a < last_b;
  });
  number(mesh, constraints, groups, pattern);
  return pattern;
}

NodePattern order_nodes(const TetMesh& mesh, const Constraints& constraints, VertexOrdering method,
                        const CoupledNodes& coupled) {
  const Groups groups(coupled, mesh.nodes.rows());
  NodePattern pattern = fill_reducing_order(mesh, constraints, method, coupled);
  Elimination elimination =
      analyze(pattern.start, pattern.neighbor, free_components(constraints, pattern.order));
  std::vector<int> order;
  order.reserve(pattern.order.size());
  for (const int k : elimination.order) order.push_back(pattern.order[at(k)]);
  pattern.order = std::move(order);
  pattern.supernodes = std::move(elimination.supernodes);
  number(mesh, constraints, groups, pattern);
  return pattern;
}

Eigen::MatrixXd nodal_columns(const NodePattern& pattern, const Eigen::MatrixXd& free) {
  const Eigen::Index n = static_cast<Eigen::Index>(pattern.equation.size());
  Eigen::MatrixXd nodal = Eigen::MatrixXd::Zero(n, free.cols());
  for (Eigen::Index d = 0; d < n; ++d) {
    const int equation = pattern.equation[static_cast<std::size_t>(d)];
    if (equation >= 0) nodal.row(d) = free.row(equation);
  }
  return nodal;
}

}  // namespace codesign::fem
