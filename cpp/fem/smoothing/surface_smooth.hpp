#pragma once

#include <string>

#include "fem/surface/surface_mesh.hpp"

namespace codesign::fem {

// What was done to a surface.
struct SmoothReport {
  int facets = 0;              // triangles replaced by curved ones
  double max_distance = 0.0;   // of a new point from its place on the triangle replaced, m
  double volume_change = 0.0;  // relative
  int left = 0;                // triangles left flat: curving them would fold the surface
  std::string reason;          // why nothing was curved at all; empty otherwise
};

// A smoothed surface.
struct SmoothSurface {
  SurfaceMesh surface;
  SmoothReport report;
};

// The smooth surface of which `surface` is a coarse tessellation, again as triangles, finer where
// it is curved (pieces that turn by less than about 10 degrees). The points of the given surface
// stay; triangles that are chords of curved faces (smooth_normals) are replaced by pieces of
// point-normal patches, sharp edges between curved faces by arcs, flat faces keep their plane and
// get new triangles inside their rounded outlines. Each piece has the face of its triangle. What
// folds or crosses stays as it was; a surface that would still cross itself is returned unchanged,
// with the reason. feature_angle [rad]: edges sharper than this are edges of the solid. Throws
// MeshError if `surface` bounds no solid, std::invalid_argument if the angle is not in (0°, 90°).
SmoothSurface smooth_surface(const SurfaceMesh& surface, double feature_angle);

}  // namespace codesign::fem
