#include "fem/stress/history_peak.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "fem/mesh/tet10.hpp"
#include "interrupt.hpp"
#include "model_error.hpp"

namespace codesign::fem {

namespace {

using Eigen::Index;

constexpr Index kBlock = 32;         // instants
constexpr Index kNodesAtOnce = 256;  // of a product with the centers of all blocks
constexpr double kRoundOff = 1e-12;  // a bound this close to the peak does not rule out

// Stress of the unit loads at a node, one column a load.
using UnitStress = Eigen::Matrix<double, 6, Eigen::Dynamic>;

// Control points of the quadratic field on the edges take the place of the mid-edge nodes.
StressFields control_points(const TetMesh& mesh, const StressFields& nodal) {
  StressFields control = nodal;
  for (Index e = 0; e < mesh.tets.rows(); ++e) {
    for (int k = 0; k < 6; ++k) {
      const int a = mesh.tets(e, kTetEdges[k][0]), b = mesh.tets(e, kTetEdges[k][1]);
      const int middle = mesh.tets(e, 4 + k);
      control.row(middle) = 2.0 * nodal.row(middle) - 0.5 * (nodal.row(a) + nodal.row(b));
    }
  }
  return control;
}

// Stress of the unit loads at node n, as a (6, units) matrix.
auto at_node(const StressFields& fields, Index n) {
  return Eigen::Map<const UnitStress>(fields.row(n).data(), 6, fields.cols() / 6);
}

Voigt at_instant(const StressFields& fields, Index n, const LoadHistory& history, Index t) {
  return at_node(fields, n) * history.row(t).transpose();
}

struct Block {
  Index first = 0, size = 0, center = 0;
  Eigen::VectorXd reach;  // (units) largest change of each factor from the center's
};

std::vector<Block> blocks_of(const LoadHistory& history) {
  std::vector<Block> blocks;
  for (Index first = 0; first < history.rows(); first += kBlock) {
    Block block;
    block.first = first;
    block.size = std::min(kBlock, history.rows() - first);
    block.center = first + block.size / 2;
    block.reach = (history.middleRows(first, block.size).rowwise() - history.row(block.center))
                      .cwiseAbs()
                      .colwise()
                      .maxCoeff();
    blocks.push_back(std::move(block));
  }
  return blocks;
}

struct Bounds {
  Eigen::MatrixXd most;  // (nodes, blocks) of the von Mises stress of a control point over a block
  double least = 0.0;    // of the peak: the largest stress of a sampled node at a block's center
};

// sampled: nodes where the peak is read.
Bounds bounds_of(const StressFields& control, const NodeFlags& sampled, const LoadHistory& history,
                 const std::vector<Block>& blocks) {
  const Index units = control.cols() / 6, count = static_cast<Index>(blocks.size());
  Eigen::MatrixXd centers(units, count), reaches(units, count);
  for (Index b = 0; b < count; ++b) {
    centers.col(b) = history.row(blocks[static_cast<std::size_t>(b)].center).transpose();
    reaches.col(b) = blocks[static_cast<std::size_t>(b)].reach;
  }
  Bounds bounds{Eigen::MatrixXd(control.rows(), count)};
  for (Index first = 0; first < control.rows(); first += kNodesAtOnce) {
    check_interrupt();
    const Index size = std::min(kNodesAtOnce, control.rows() - first);
    Eigen::MatrixXd stress(6 * size, units), sizes(size, units);
    for (Index i = 0; i < size; ++i) {
      const auto unit = at_node(control, first + i);
      stress.middleRows<6>(6 * i) = unit;
      for (Index u = 0; u < units; ++u) sizes(i, u) = von_mises(Voigt(unit.col(u)));
    }
    const Eigen::MatrixXd at_centers = stress * centers;
    bounds.most.middleRows(first, size).noalias() = sizes * reaches;
    for (Index b = 0; b < count; ++b) {
      for (Index i = 0; i < size; ++i) {
        const double value = von_mises(Voigt(at_centers.col(b).segment<6>(6 * i)));
        bounds.most(first + i, b) += value;
        if (sampled[first + i]) bounds.least = std::max(bounds.least, value);
      }
    }
  }
  return bounds;
}

// Corner nodes of the surface where the peak is read: there the control points are the field.
NodeFlags sampled_nodes(const TetMesh& mesh, const ExclusionZone& zone) {
  NodeFlags corner = NodeFlags::Constant(mesh.nodes.rows(), false);
  for (Index t = 0; t < mesh.boundary.rows(); ++t) {
    for (int k = 0; k < 3; ++k) corner[mesh.boundary(t, k)] = true;
  }
  return corner && counted_nodes(mesh, zone);
}

// A boundary face (row of TetMesh::boundary) or, after these, an element, in a block of instants.
struct Candidate {
  double bound;
  Index item;
  std::size_t block;
};

class Search {
 public:
  Search(const TetMesh& mesh, const StressFields& units, const LoadHistory& history,
         const ExclusionZone& zone, bool inside)
      : mesh_(mesh),
        units_(units),
        control_(control_points(mesh, units)),
        history_(history),
        zone_(zone),
        blocks_(blocks_of(history)) {
    const Index faces = mesh.boundary.rows();
    for (Index t = 0; t < faces; ++t) {
      if (!zone.skips(static_cast<int>(t))) items_.push_back(t);
    }
    for (Index e = 0; inside && e < mesh.tets.rows(); ++e) items_.push_back(faces + e);
  }

  HistoryPeak run() {
    std::vector<Candidate> candidates = all_candidates();
    found_.pairs = items_.size() * blocks_.size();
    std::sort(candidates.begin(), candidates.end(),
              [](const Candidate& a, const Candidate& b) { return a.bound > b.bound; });
    for (const Candidate& candidate : candidates) {
      if (!may_hold_more(candidate.bound)) break;
      check_interrupt();
      ++found_.visited;
      visit(candidate);
    }
    return found_;
  }

 private:
  std::vector<int> nodes_of(Index item) const {
    const Index faces = mesh_.boundary.rows();
    std::vector<int> nodes;
    if (item < faces) {
      for (int k = 0; k < 6; ++k) nodes.push_back(mesh_.boundary(item, k));
    } else {
      for (int k = 0; k < kTetNodes; ++k) nodes.push_back(mesh_.tets(item - faces, k));
    }
    return nodes;
  }

  bool may_hold_more(double bound) const {
    return !found_.peak.read() || bound > found_.peak.value * (1.0 - kRoundOff);
  }

  std::vector<Candidate> all_candidates() const {
    const Bounds bounds = bounds_of(control_, sampled_nodes(mesh_, zone_), history_, blocks_);
    std::vector<Candidate> candidates;
    for (const Index item : items_) {
      const std::vector<int> nodes = nodes_of(item);
      for (std::size_t b = 0; b < blocks_.size(); ++b) {
        double bound = 0.0;
        for (const int n : nodes) bound = std::max(bound, bounds.most(n, static_cast<Index>(b)));
        if (bound >= bounds.least * (1.0 - kRoundOff)) candidates.push_back({bound, item, b});
      }
    }
    return candidates;
  }

  void visit(const Candidate& candidate) {
    const Block& block = blocks_[candidate.block];
    const std::vector<int> nodes = nodes_of(candidate.item);
    for (Index t = block.first; t < block.first + block.size; ++t) {
      double bound = 0.0;
      for (const int n : nodes) {
        bound = std::max(bound, von_mises(at_instant(control_, n, history_, t)));
      }
      if (!may_hold_more(bound)) continue;
      Eigen::Matrix<double, 6, Eigen::Dynamic> stress(6, static_cast<Index>(nodes.size()));
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        stress.col(static_cast<Index>(i)) = at_instant(units_, nodes[i], history_, t);
      }
      const PeakStress before = found_.peak;
      raise(candidate.item, stress);
      const bool first = found_.peak.read() && !before.read();
      if (first || found_.peak.value > before.value) found_.instant = t;
    }
  }

  void raise(Index item, const Eigen::Matrix<double, 6, Eigen::Dynamic>& stress) {
    const Index faces = mesh_.boundary.rows();
    if (item < faces) {
      raise_on_face(mesh_, FaceStress(stress), static_cast<int>(item), zone_, false, found_.peak);
    } else {
      raise_in_element(mesh_, ElementStress(stress), static_cast<int>(item - faces), zone_,
                       found_.peak);
    }
  }

  const TetMesh& mesh_;
  const StressFields& units_;
  const StressFields control_;
  const LoadHistory& history_;
  const ExclusionZone& zone_;
  const std::vector<Block> blocks_;
  std::vector<Index> items_;
  HistoryPeak found_;
};

}  // namespace

HistoryPeak history_peak(const TetMesh& mesh, const StressFields& units, const LoadHistory& history,
                         const ExclusionZone& zone, bool inside) {
  if (history.rows() < 1 || 6 * history.cols() != units.cols()) {
    throw std::invalid_argument("a history of loads needs rows, and a column for each of the " +
                                std::to_string(units.cols() / 6) + " unit loads");
  }
  if (!history.allFinite()) throw std::invalid_argument("a history of loads must be finite");
  HistoryPeak found = Search(mesh, units, history, zone, inside).run();
  if (found.instant < 0) throw_no_place_left();
  return found;
}

}  // namespace codesign::fem
