#include "fem/la/supernodes.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace codesign::fem {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

struct Graph {  // neighbors below k of each k, from the given ones above
  std::vector<int> start, neighbor;
};

Graph transpose(const std::vector<int>& start, const std::vector<int>& neighbor) {
  Graph result;
  result.start.assign(start.size(), 0);
  result.neighbor.resize(neighbor.size());
  for (const int j : neighbor) ++result.start[at(j) + 1];
  std::partial_sum(result.start.begin(), result.start.end(), result.start.begin());
  std::vector<int> next(result.start.begin(), result.start.end() - 1);
  for (int k = 0; k + 1 < static_cast<int>(start.size()); ++k) {
    for (int p = start[at(k)]; p < start[at(k) + 1]; ++p) {
      result.neighbor[at(next[at(neighbor[at(p)])]++)] = k;
    }
  }
  return result;
}

// Elimination tree (Liu, path compression); -1 at a root.
std::vector<int> elimination_tree(const Graph& below) {
  const int n = static_cast<int>(below.start.size()) - 1;
  std::vector<int> parent(at(n), -1), ancestor(at(n), -1);
  for (int k = 0; k < n; ++k) {
    for (int p = below.start[at(k)]; p < below.start[at(k) + 1]; ++p) {
      int i = below.neighbor[at(p)];
      while (i != -1 && i < k) {
        const int above = ancestor[at(i)];
        ancestor[at(i)] = k;
        if (above == -1) parent[at(i)] = k;
        i = above;
      }
    }
  }
  return parent;
}

// Children before parents, every subtree contiguous.
std::vector<int> postorder(const std::vector<int>& parent) {
  const int n = static_cast<int>(parent.size());
  std::vector<int> child(at(n), -1), sibling(at(n), -1), stack, result;
  for (int k = n - 1; k >= 0; --k) {
    if (parent[at(k)] < 0) continue;
    sibling[at(k)] = child[at(parent[at(k)])];
    child[at(parent[at(k)])] = k;
  }
  result.reserve(at(n));
  for (int root = 0; root < n; ++root) {
    if (parent[at(root)] >= 0) continue;
    stack.push_back(root);
    while (!stack.empty()) {
      const int k = stack.back();
      if (child[at(k)] >= 0) {
        stack.push_back(child[at(k)]);
        child[at(k)] = sibling[at(stack.back())];
      } else {
        result.push_back(k);
        stack.pop_back();
      }
    }
  }
  return result;
}

// Number of indices in each column of the factor, the diagonal included: walks the row subtrees.
std::vector<int> column_counts(const Graph& below, const std::vector<int>& parent) {
  const int n = static_cast<int>(parent.size());
  std::vector<int> count(at(n), 1), seen(at(n), -1);
  for (int k = 0; k < n; ++k) {
    seen[at(k)] = k;
    for (int p = below.start[at(k)]; p < below.start[at(k) + 1]; ++p) {
      for (int i = below.neighbor[at(p)]; seen[at(i)] != k; i = parent[at(i)]) {
        seen[at(i)] = k;
        ++count[at(i)];
      }
    }
  }
  return count;
}

// A supernode while they are being merged; columns and rows in the old order's indices.
struct Group {
  std::vector<int> columns, rows;  // rows: below the columns
  int parent = -1;                 // group
  double width = 0.0;              // equations of its columns
  double height = 0.0;             // equations of its rows
  double zeros = 0.0;              // explicit zeros accepted so far, entries

  double front() const { return width + height; }
  double entries() const { return 0.5 * width * (width + 1.0) + width * height; }
};

double weigh(const std::vector<int>& indices, const std::vector<int>& weight) {
  double sum = 0.0;
  for (const int i : indices) sum += weight[at(i)];
  return sum;
}

// Supernodes without zeros, each with its rows, children before parents.
std::vector<Group> find_groups(const std::vector<int>& start, const std::vector<int>& neighbor,
                               const std::vector<int>& weight, std::vector<int>& group_of) {
  const int n = static_cast<int>(start.size()) - 1;
  const Graph below = transpose(start, neighbor);
  const std::vector<int> parent = elimination_tree(below);
  const std::vector<int> count = column_counts(below, parent);
  const std::vector<int> sequence = postorder(parent);
  group_of.assign(at(n), -1);
  std::vector<Group> groups;
  std::vector<std::vector<int>> children;
  std::vector<int> seen(at(n), -1);
  int previous = -1;
  for (const int k : sequence) {
    const bool joins =
        previous >= 0 && parent[at(previous)] == k && count[at(previous)] == count[at(k)] + 1;
    if (!joins) {
      groups.emplace_back();
      children.emplace_back();
    }
    const int g = static_cast<int>(groups.size()) - 1;
    group_of[at(k)] = g;
    groups.back().columns.push_back(k);
    previous = k;
  }
  for (int g = 0; g < static_cast<int>(groups.size()); ++g) {
    Group& group = groups[at(g)];
    for (const int k : group.columns) seen[at(k)] = g;
    const auto add = [&](int row) {
      if (seen[at(row)] == g) return;
      seen[at(row)] = g;
      group.rows.push_back(row);
    };
    for (const int k : group.columns) {
      for (int p = start[at(k)]; p < start[at(k) + 1]; ++p) add(neighbor[at(p)]);
    }
    for (const int child : children[at(g)]) {
      for (const int row : groups[at(child)].rows) add(row);
    }
    const int above = parent[at(group.columns.back())];
    if (above >= 0) {
      group.parent = group_of[at(above)];
      children[at(group.parent)].push_back(g);
    }
    group.width = weigh(group.columns, weight);
    group.height = weigh(group.rows, weight);
  }
  return groups;
}

// Whether a merged front of this size may hold this share of explicit zeros.
bool acceptable(double front, double width, double share) {
  if (width <= 12.0) return true;
  if (front <= 48.0) return share < 0.5;
  if (width <= 96.0) return share < 0.15;
  return share < 0.05;
}

// Merges groups into their parents, children first. The rows of a child lie in the parent's
// columns and rows, so the merged rows are the parent's.
void merge_groups(std::vector<Group>& groups) {
  std::vector<std::vector<int>> children(groups.size());
  for (int g = 0; g < static_cast<int>(groups.size()); ++g) {
    if (groups[at(g)].parent >= 0) children[at(groups[at(g)].parent)].push_back(g);
  }
  for (int g = 0; g < static_cast<int>(groups.size()); ++g) {
    Group& parent = groups[at(g)];
    std::vector<int>& candidates = children[at(g)];
    // The child that brings the fewest zeros first.
    std::sort(candidates.begin(), candidates.end(), [&](int a, int b) {
      return parent.front() - groups[at(a)].height < parent.front() - groups[at(b)].height;
    });
    for (const int c : candidates) {
      Group& child = groups[at(c)];
      const double added = child.width * (parent.front() - child.height);
      const double width = child.width + parent.width, front = width + parent.height;
      const double zeros = parent.zeros + child.zeros + added;
      const double total = 0.5 * width * (width + 1.0) + width * parent.height;
      if (!acceptable(front, width, zeros / total)) continue;
      parent.columns.insert(parent.columns.begin(), child.columns.begin(), child.columns.end());
      parent.width = width;
      parent.zeros = zeros;
      child.columns.clear();
      child.rows.clear();
    }
  }
}

// Parents among the groups that are left.
std::vector<int> remaining_parents(const std::vector<Group>& groups) {
  std::vector<int> parent(groups.size(), -1);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    int above = groups[g].parent;
    while (above >= 0 && groups[at(above)].columns.empty()) above = groups[at(above)].parent;
    parent[g] = above;
  }
  return parent;
}

}  // namespace

Elimination analyze(const std::vector<int>& start, const std::vector<int>& neighbor,
                    const std::vector<int>& weight) {
  std::vector<int> group_of;
  std::vector<Group> groups = find_groups(start, neighbor, weight, group_of);
  merge_groups(groups);
  Elimination result;
  Supernodes& s = result.supernodes;
  std::vector<int> position(weight.size()), kept;
  s.start.push_back(0);
  for (const int g : postorder(remaining_parents(groups))) {
    if (groups[at(g)].columns.empty()) continue;
    kept.push_back(g);
    for (const int column : groups[at(g)].columns) {
      position[at(column)] = static_cast<int>(result.order.size());
      result.order.push_back(column);
    }
    s.start.push_back(static_cast<int>(result.order.size()));
  }
  s.row_start.push_back(0);
  for (const int g : kept) {
    const Group& group = groups[at(g)];
    for (const int row : group.rows) s.row.push_back(position[at(row)]);
    std::sort(s.row.begin() + s.row_start.back(), s.row.end());
    s.row_start.push_back(static_cast<int>(s.row.size()));
    const double w = group.width, f = group.front();
    s.entries += w * f;
    s.operations += w * f * f - w * w * f + w * w * w / 3.0;
  }
  return result;
}

}  // namespace codesign::fem
