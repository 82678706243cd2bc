#pragma once

#include <vector>

#include "fem/smoothing/edge_arcs.hpp"

namespace codesign::fem {

// A surface with the coarse triangle that each of its triangles comes from.
struct SplitSurface {
  SurfaceMesh surface;
  std::vector<int> parent;
  double max_distance = 0.0;  // of a new point from its place on the coarse triangle, m
  int curved = 0;             // coarse triangles replaced
  std::vector<int> folded;    // coarse triangles whose curved pieces turn over
};

// Cuts every curved triangle along its arcs and puts the new points onto its point-normal patch (A.
// Vlachos, J. Peters, C. Boyd, J. L. Mitchell: "Curved PN triangles", I3D 2001), cubic between the
// arcs of its edges. Points of an edge are made once and shared: no gaps, no T-junctions. Flats get
// new triangles between their curved outlines.
SplitSurface split_patches(const SurfaceMesh& surface, const SmoothNormals& normals,
                           const EdgeArcs& arcs);

}  // namespace codesign::fem
