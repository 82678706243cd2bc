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
constexpr Index kNodesAtOnce = 256;  // of a product with the ends of all blocks
constexpr double kRoundOff = 1e-12;  // a bound this close to the peak does not rule out

// Stress in columns: of the unit loads at a node, or of the nodes of a face.
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

// Instants from first to last, both included; the last one is the first of the next block.
struct Block {
  Index first = 0, last = 0;
  Eigen::VectorXd bulge;  // (units) largest distance of each factor from the chord of its block
};

std::vector<Block> blocks_of(const LoadHistory& history) {
  std::vector<Block> blocks;
  const Index end = history.rows() - 1;
  for (Index first = 0; blocks.empty() || first < end; first += kBlock) {
    Block block{first, std::min(first + kBlock, end), Eigen::VectorXd::Zero(history.cols())};
    for (Index t = block.first + 1; t < block.last; ++t) {
      const double share =
          static_cast<double>(t - block.first) / static_cast<double>(block.last - block.first);
      const Eigen::VectorXd chord = (1.0 - share) * history.row(block.first).transpose() +
                                    share * history.row(block.last).transpose();
      block.bulge = block.bulge.cwiseMax((history.row(t).transpose() - chord).cwiseAbs());
    }
    blocks.push_back(std::move(block));
  }
  return blocks;
}

struct Bounds {
  Eigen::MatrixXd most;  // (nodes, blocks) of the von Mises stress of a control point over a block
  double least = 0.0;    // of the peak: the largest stress of a sampled node at an end of a block
};

// The instants at which blocks begin and end.
std::vector<Index> ends_of(const std::vector<Block>& blocks) {
  std::vector<Index> ends{blocks.front().first};
  for (const Block& block : blocks) ends.push_back(block.last);
  return ends;
}

// sampled: nodes where the peak is read.
Bounds bounds_of(const StressFields& control, const NodeFlags& sampled, const LoadHistory& history,
                 const std::vector<Block>& blocks) {
  const Index units = control.cols() / 6, count = static_cast<Index>(blocks.size());
  const std::vector<Index> ends = ends_of(blocks);
  const Eigen::MatrixXd factors = history(ends, Eigen::all).transpose();
  Eigen::MatrixXd bulges(units, count);
  for (Index b = 0; b < count; ++b) bulges.col(b) = blocks[static_cast<std::size_t>(b)].bulge;
  Bounds bounds{Eigen::MatrixXd(control.rows(), count)};
  for (Index first = 0; first < control.rows(); first += kNodesAtOnce) {
    check_interrupt();
    const Index size = std::min(kNodesAtOnce, control.rows() - first);
    Eigen::MatrixXd stress(6 * size, units), sizes(size, units), mises(size, count + 1);
    for (Index i = 0; i < size; ++i) {
      const auto unit = at_node(control, first + i);
      stress.middleRows<6>(6 * i) = unit;
      for (Index u = 0; u < units; ++u) sizes(i, u) = von_mises(Voigt(unit.col(u)));
    }
    const Eigen::MatrixXd at_ends = stress * factors;
    for (Index b = 0; b <= count; ++b) {
      for (Index i = 0; i < size; ++i) {
        mises(i, b) = von_mises(Voigt(at_ends.col(b).segment<6>(6 * i)));
        if (sampled[first + i]) bounds.least = std::max(bounds.least, mises(i, b));
      }
    }
    bounds.most.middleRows(first, size) =
        mises.leftCols(count).cwiseMax(mises.rightCols(count)) + sizes * bulges;
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

// Places that are looked at together: a boundary face (row of TetMesh::boundary) or, after these,
// an element; and the rows of a field whose von Mises stress bounds that of its places.
struct Item {
  Index shape;
  std::vector<int> rows;
};

// All items with places outside the zone, and the field that bounds them: control points, then the
// places themselves of those items of which the zone leaves out some, since the control points
// inside it may be stressed far beyond all that counts.
class Items {
 public:
  Items(const TetMesh& mesh, const StressFields& units, const ExclusionZone& zone, bool inside)
      : mesh_(mesh), units_(units), zone_(zone), rows_(units.rows()) {
    const Index faces = mesh.boundary.rows();
    for (Index t = 0; t < faces; ++t) add_face(t);
    for (Index e = 0; inside && e < mesh.tets.rows(); ++e) add_element(e, faces + e);
    field_ = control_points(mesh, units);
    field_.conservativeResize(rows_, Eigen::NoChange);
    for (std::size_t i = 0; i < places_.size(); ++i) {
      field_.row(units.rows() + static_cast<Index>(i)) = at_place(places_[i]);
    }
  }

  const std::vector<Item>& list() const { return list_; }
  const StressFields& field() const { return field_; }

  // Nodes of an item, the same for all of a kind in number.
  std::vector<int> nodes(Index shape) const {
    const Index faces = mesh_.boundary.rows();
    std::vector<int> nodes;
    for (int k = 0; shape < faces && k < 6; ++k) nodes.push_back(mesh_.boundary(shape, k));
    for (int k = 0; shape >= faces && k < kTetNodes; ++k) {
      nodes.push_back(mesh_.tets(shape - faces, k));
    }
    return nodes;
  }

 private:
  struct Place {
    std::vector<int> nodes;
    Eigen::VectorXd values;
  };

  Eigen::RowVectorXd at_place(const Place& place) const {
    Eigen::RowVectorXd stress = Eigen::RowVectorXd::Zero(units_.cols());
    for (std::size_t k = 0; k < place.nodes.size(); ++k) {
      stress += place.values[static_cast<Index>(k)] * units_.row(place.nodes[k]);
    }
    return stress;
  }

  void add_place(Item& item, const Eigen::VectorXd& values) {
    places_.push_back({nodes(item.shape), values});
    item.rows.push_back(static_cast<int>(rows_++));
  }

  void add_face(Index t) {
    const Side side = side_of_face(mesh_, static_cast<int>(t), zone_);
    if (side == Side::inside) return;
    Item item{t, {}};
    if (side == Side::outside) item.rows = nodes(t);
    const FaceNodes x = face_nodes(mesh_, static_cast<int>(t));
    for (const FaceSample& sample : face_samples()) {
      if (side == Side::both && !zone_.contains(x * sample.values)) add_place(item, sample.values);
    }
    if (!item.rows.empty()) list_.push_back(std::move(item));
  }

  void add_element(Index e, Index shape) {
    const TetNodes x = tet_nodes(mesh_, static_cast<int>(e));
    const Eigen::Vector3d center = x.leftCols<4>().rowwise().mean();
    const double radius = (x.colwise() - center).colwise().norm().maxCoeff();
    if (zone_.contains_ball(center, radius)) return;
    Item item{shape, {}};
    if (!zone_.touches_ball(center, radius)) {
      item.rows = nodes(shape);
    } else {
      for (const Eigen::Vector3d& point : tet_rule_4().points) {
        const TetValues values = tet10_values(point);
        if (!zone_.contains(x * values)) add_place(item, values);
      }
    }
    if (!item.rows.empty()) list_.push_back(std::move(item));
  }

  const TetMesh& mesh_;
  const StressFields& units_;
  const ExclusionZone& zone_;
  Index rows_;
  std::vector<Place> places_;
  std::vector<Item> list_;
  StressFields field_;
};

struct Candidate {
  double bound;
  const Item* item;
  const Block* block;
};

class Search {
 public:
  Search(const TetMesh& mesh, const StressFields& units, const LoadHistory& history,
         const ExclusionZone& zone, bool inside)
      : mesh_(mesh),
        units_(units),
        history_(history),
        zone_(zone),
        items_(mesh, units, zone, inside),
        blocks_(blocks_of(history)) {}

  HistoryPeak run() {
    std::vector<Candidate> candidates = all_candidates();
    found_.pairs = items_.list().size() * blocks_.size();
    std::sort(candidates.begin(), candidates.end(),
              [](const Candidate& a, const Candidate& b) { return a.bound > b.bound; });
    for (const Candidate& candidate : candidates) {
      if (!may_hold_more(candidate.bound)) break;
      check_interrupt();
      ++found_.visited;
      visit(*candidate.item, *candidate.block);
    }
    return found_;
  }

 private:
  bool may_hold_more(double bound) const {
    return !found_.peak.read() || bound > found_.peak.value * (1.0 - kRoundOff);
  }

  std::vector<Candidate> all_candidates() const {
    NodeFlags sampled = NodeFlags::Constant(items_.field().rows(), true);  // places are
    sampled.head(mesh_.nodes.rows()) = sampled_nodes(mesh_, zone_);
    const Bounds bounds = bounds_of(items_.field(), sampled, history_, blocks_);
    std::vector<Candidate> candidates;
    for (const Item& item : items_.list()) {
      for (std::size_t b = 0; b < blocks_.size(); ++b) {
        double bound = 0.0;
        for (const int row : item.rows) {
          bound = std::max(bound, bounds.most(row, static_cast<Index>(b)));
        }
        if (bound >= bounds.least * (1.0 - kRoundOff)) {
          candidates.push_back({bound, &item, &blocks_[b]});
        }
      }
    }
    return candidates;
  }

  static Eigen::MatrixXd stacked(const StressFields& fields, const std::vector<int>& rows) {
    Eigen::MatrixXd unit(6 * static_cast<Index>(rows.size()), fields.cols() / 6);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      unit.middleRows<6>(6 * static_cast<Index>(i)) = at_node(fields, rows[i]);
    }
    return unit;
  }

  void visit(const Item& item, const Block& block) {
    const Index instants = block.last - block.first + 1;
    const Eigen::MatrixXd factors = history_.middleRows(block.first, instants).transpose();
    const Eigen::MatrixXd bounding = stacked(items_.field(), item.rows) * factors;
    const std::vector<int> nodes = items_.nodes(item.shape);
    const Eigen::MatrixXd unit = stacked(units_, nodes);
    for (Index t = 0; t < instants; ++t) {
      double bound = 0.0;
      for (Index i = 0; i < bounding.rows(); i += 6) {
        bound = std::max(bound, von_mises(Voigt(bounding.col(t).segment<6>(i))));
      }
      if (!may_hold_more(bound)) continue;
      const Eigen::VectorXd stress = unit * factors.col(t);
      const PeakStress before = found_.peak;
      raise(item.shape, Eigen::Map<const UnitStress>(stress.data(), 6, unit.rows() / 6));
      const bool first = found_.peak.read() && !before.read();
      if (first || found_.peak.value > before.value) found_.instant = block.first + t;
    }
  }

  void raise(Index shape, const UnitStress& stress) {
    const Index faces = mesh_.boundary.rows();
    if (shape < faces) {
      raise_on_face(mesh_, FaceStress(stress), static_cast<int>(shape), zone_, false, found_.peak);
    } else {
      raise_in_element(mesh_, ElementStress(stress), static_cast<int>(shape - faces), zone_,
                       found_.peak);
    }
  }

  const TetMesh& mesh_;
  const StressFields& units_;
  const LoadHistory& history_;
  const ExclusionZone& zone_;
  const Items items_;
  const std::vector<Block> blocks_;
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
