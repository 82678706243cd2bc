#pragma once

#include <string>
#include <string_view>

#include "fem/surface/surface_mesh.hpp"

namespace codesign::fem {

// Largest number of triangles read from a file or given to the mesher.
inline constexpr std::size_t kMaxTriangles = 2'000'000;

// Triangles of an STL file, binary or ASCII (told apart by the length that a binary header
// promises, not by the word "solid"). Corners with equal coordinates become one point, and points
// closer than the single-precision resolution are merged if the surface would be open otherwise.
// One unnamed face. Throws MeshError: empty, truncated, not a number (with line or triangle), too
// many triangles. scale: meters per unit of the file.
SurfaceMesh parse_stl(std::string_view bytes, double scale);

// parse_stl of a file, with the file's name in front of every message.
SurfaceMesh read_stl(const std::string& path, double scale);

}  // namespace codesign::fem
