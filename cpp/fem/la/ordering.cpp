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

bool is_last(const std::vector<char>& last, int node) { return !last.empty() && last[at(node)]; }

// Rank of each free corner vertex in a fill-reducing order of the vertex graph; -1 for others.
// Vertices that are to be last share the highest rank.
std::vector<int> vertex_ranks(const TetMesh& mesh, const Constraints& constraints,
                              const std::vector<char>& last, VertexOrdering method) {
  const Incidence elements = elements_of_nodes(mesh, 4);
  const int nodes = static_cast<int>(mesh.nodes.rows());
  std::vector<int> index(at(nodes), -1), vertex;
  for (int v = 0; v < nodes; ++v) {
    if (elements.start[at(v)] == elements.start[at(v) + 1] || !has_free_component(constraints, v))
      continue;
    if (is_last(last, v)) continue;
    index[at(v)] = static_cast<int>(vertex.size());
    vertex.push_back(v);
  }
  std::vector<int> start{0}, column, seen(vertex.size(), -1);
  for (std::size_t k = 0; k < vertex.size(); ++k) {
    const int v = vertex[k];
    for (int j = elements.start[at(v)]; j < elements.start[at(v) + 1]; ++j) {
      for (int i = 0; i < 4; ++i) {
        const int other = index[at(mesh.tets(elements.element[at(j)], i))];
        if (other <= static_cast<int>(k) || seen[at(other)] == static_cast<int>(k)) continue;
        seen[at(other)] = static_cast<int>(k);
        column.push_back(other);
      }
    }
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
    if (used && is_last(last, v) && has_free_component(constraints, v))
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

void find_neighbors(const TetMesh& mesh, const Incidence& elements, const std::vector<char>& last,
                    NodePattern& pattern) {
  std::vector<int> seen(pattern.order.size(), -1);
  pattern.start.assign(1, 0);
  pattern.neighbor.clear();
  for (int k = 0; k < pattern.positions(); ++k) {
    const int node = pattern.order[at(k)];
    for (int j = elements.start[at(node)]; j < elements.start[at(node) + 1]; ++j) {
      const int* tet = mesh.tets.row(elements.element[at(j)]).data();
      for (int i = 0; i < kTetNodes; ++i) {
        const int other = pattern.position[at(tet[i])];
        if (other <= k || seen[at(other)] == k) continue;
        seen[at(other)] = k;
        pattern.neighbor.push_back(other);
      }
    }
    for (int other = k + 1; is_last(last, node) && other < pattern.positions(); ++other) {
      if (!is_last(last, pattern.order[at(other)]) || seen[at(other)] == k) continue;
      pattern.neighbor.push_back(other);
    }
    std::sort(pattern.neighbor.begin() + pattern.start.back(), pattern.neighbor.end());
    pattern.start.push_back(static_cast<int>(pattern.neighbor.size()));
  }
}

// Positions, neighbors and equations of nodes in their order.
void number(const TetMesh& mesh, const Constraints& constraints, const std::vector<char>& last,
            NodePattern& pattern) {
  set_positions(at(static_cast<int>(mesh.nodes.rows())), pattern);
  find_neighbors(mesh, elements_of_nodes(mesh, kTetNodes), last, pattern);
  number_equations(constraints, pattern);
}

}  // namespace

NodePattern fill_reducing_order(const TetMesh& mesh, const Constraints& constraints,
                                VertexOrdering method, const std::vector<char>& last) {
  const std::vector<int> key = node_keys(mesh, vertex_ranks(mesh, constraints, last, method));
  NodePattern pattern;
  for (int v = 0; v < mesh.nodes.rows(); ++v) {
    if (has_free_component(constraints, v)) pattern.order.push_back(v);
  }
  std::stable_sort(pattern.order.begin(), pattern.order.end(), [&](int a, int b) {
    const bool last_a = is_last(last, a), last_b = is_last(last, b);
    return last_a == last_b ? key[at(a)] < key[at(b)] : last_b;
  });
  number(mesh, constraints, last, pattern);
  return pattern;
}

NodePattern order_nodes(const TetMesh& mesh, const Constraints& constraints, VertexOrdering method,
                        const std::vector<char>& last) {
  NodePattern pattern = fill_reducing_order(mesh, constraints, method, last);
  Elimination elimination =
      analyze(pattern.start, pattern.neighbor, free_components(constraints, pattern.order));
  std::vector<int> order;
  order.reserve(pattern.order.size());
  for (const int k : elimination.order) order.push_back(pattern.order[at(k)]);
  pattern.order = std::move(order);
  pattern.supernodes = std::move(elimination.supernodes);
  number(mesh, constraints, last, pattern);
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
