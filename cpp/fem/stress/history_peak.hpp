#pragma once

#include <Eigen/Core>

#include "fem/mesh/tet_mesh.hpp"
#include "fem/stress/exclusion.hpp"
#include "fem/stress/peak_stress.hpp"
#include "fem/stress/recovery.hpp"

namespace codesign::fem {

// A row per instant, a column per unit load: how much of it acts then.
using LoadHistory = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// The largest stress of a history, where and when.
struct HistoryPeak {
  PeakStress peak;
  Eigen::Index instant = -1;  // row of the history
  // Work: pairs of a face or element and a block of instants, and how many of them were looked at
  // because no bound ruled them out.
  std::size_t pairs = 0, visited = 0;
};

// The largest von Mises stress over all instants of a history and all places that peak_stress reads
// (66 points of each boundary face outside the zone), and with `inside` at the four points of each
// element too. `units` holds the recovered stress of the unit loads at the nodes, six columns each.
//
// The result is that of a search of all pairs of a place and an instant: von Mises stress is
// convex, so over a face or an element and a block of instants it is bounded by its values at the
// control points for the first and the last instant, plus the unit stresses there times the largest
// distance of the factors from the chord between the two. Only what the bound does not rule out is
// computed. Throws ModelError if the zone leaves no point, std::invalid_argument if sizes differ.
HistoryPeak history_peak(const TetMesh& mesh, const StressFields& units, const LoadHistory& history,
                         const ExclusionZone& zone, bool inside);

}  // namespace codesign::fem
