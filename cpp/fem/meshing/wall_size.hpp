#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/meshing/mesh_options.hpp"
#include "fem/meshing/size_field.hpp"
#include "fem/meshing/surface_match.hpp"
#include "fem/meshing/wall_samples.hpp"
#include "fem/surface/surface_mesh.hpp"

namespace codesign::fem {

inline constexpr double kOfWall = 0.85;  // edge length relative to the wall: below 1 also between
                                         // samples, lines on one side keep away from the other side
inline constexpr double kMostElements = 250'000;  // that thin walls may ask for, about

// Edge length from the mean wall thickness 2 · volume / area, limited by the number of elements.
// [m]
double mean_wall_size(const SurfaceMesh& surface);

// `base` where the walls are thick, kOfWall of the local wall thickness or gap where they are thin,
// also beside feature lines; graded between. Never below a twentieth of `base`, nor so small that
// more than about kMostElements elements would be needed. Throws MeshError for surfaces that
// bound no solid, MeshLimitError at once if elements of `base` cannot fill it within
// options.max_vertices, std::invalid_argument unless base > 0.
SizeField wall_size(const SurfaceMesh& surface, double base, const MeshOptions& options = {});

// A size field with smaller elements at the given places: kOfWall of the walls around, half the
// length there if no wall around is thin; in later rounds less of the walls and half the edges that
// the mesh has there. round: from 1.
SizeField refine_at(const SizeField& size, const std::vector<Mismatch>& mismatches,
                    const std::vector<WallSample>& walls, int round);

}  // namespace codesign::fem
