#include "fem/meshing/tet_mesher.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "errors.hpp"
#include "fem/mesh/mesh_quality.hpp"
#include "fem/meshing/curved_edges.hpp"
#include "fem/meshing/delaunay_mesher.hpp"
#include "fem/meshing/linear_tets.hpp"
#include "fem/meshing/mesh_watch.hpp"
#include "fem/meshing/prepared_surface.hpp"
#include "fem/meshing/tet_improve.hpp"
#include "fem/meshing/topology_keeper.hpp"

namespace codesign::fem {
namespace {

constexpr double kAreaSlack = 0.25;  // of the area of a face: beyond that, labels are wrong
constexpr double kCrumb = 1e-4;      // pieces smaller than this part of the mesh are dropped
constexpr double kStraightAngle = 168.0 * kDegree;

void check_options(const MeshOptions& options) {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw std::invalid_argument(what);
  };
  require(options.feature_angle > 0.0 && options.feature_angle < 180.0 * kDegree,
          "feature_angle: between 0 and 180 degrees");
  require(options.simplify >= 0.0, "simplify: must not be negative");
  require(options.facet_distance > 0.0 && options.facet_distance <= 1.0,
          "facet_distance: relative to the edge length, in (0, 1]");
  require(options.facet_angle >= 0.0 && options.facet_angle <= 30.0 * kDegree,
          "facet_angle: at most 30 degrees, or the refinement may not end");
  require(options.radius_edge >= 2.0, "radius_edge: at least 2, or the refinement may not end");
  require(options.topology_rounds >= 0, "topology_rounds: must not be negative");
  require(options.max_questions > 0, "max_questions: must be positive");
  require(options.time_limit > 0.0, "time_limit: must be positive");
}

// Area of each face between the corner nodes. [m²]
std::vector<double> boundary_areas(const TetMesh& mesh) {
  std::vector<double> areas(mesh.face_names.size(), 0.0);
  for (Eigen::Index i = 0; i < mesh.boundary.rows(); ++i) {
    const Eigen::RowVector3d a = mesh.nodes.row(mesh.boundary(i, 0));
    const Eigen::RowVector3d ab = mesh.nodes.row(mesh.boundary(i, 1)) - a;
    const Eigen::RowVector3d ac = mesh.nodes.row(mesh.boundary(i, 2)) - a;
    areas[static_cast<std::size_t>(mesh.boundary_face[static_cast<std::size_t>(i)])] +=
        0.5 * ab.cross(ac).norm();
  }
  return areas;
}

// Named faces one by one; unnamed ones by their sum, as nobody asked for a sliver among them.
void check_face_areas(const TetMesh& mesh, const SurfaceMesh& surface) {
  const auto check = [](const std::string& what, double found, double wanted) {
    if (std::abs(found - wanted) > kAreaSlack * wanted)
      throw MeshError(what + " the area " + std::to_string(found * 1e6) + " mm² in the mesh and " +
                      std::to_string(wanted * 1e6) +
                      " mm² on the surface: the edge length is too large");
  };
  const std::vector<double> wanted = face_areas(surface);
  const std::vector<double> found = boundary_areas(mesh);
  double unnamed_wanted = 0.0, unnamed_found = 0.0;
  for (std::size_t face = 0; face < wanted.size(); ++face) {
    if (!surface.face_names[face].empty()) {
      check("face '" + surface.face_names[face] + "' has", found[face], wanted[face]);
      continue;
    }
    unnamed_wanted += wanted[face];
    unnamed_found += found[face];
  }
  check("the unnamed faces have", unnamed_found, unnamed_wanted);
}

// How much the boundary may differ from the surface: sides keep the facet distance, sharp edges are
// lines of the mesh.
void check_against_surface(const TetMesh& mesh, const SurfaceMesh& surface, const SizeField& size,
                           const MeshOptions& options) {
  if (const int pieces = count_pieces(mesh); pieces != 1)
    throw MeshError("the mesh falls into " + std::to_string(pieces) +
                    " pieces: the surface bounds several solids");
  const MeshQuality quality = measure_quality(mesh);
  if (!(quality.min_dihedral > 0.0))
    throw MeshError("tetrahedron " + std::to_string(quality.worst_tet) + " of the mesh is flat");
  double slack = 0.0;
  for (Eigen::Index i = 0; i < mesh.boundary.rows(); ++i) {
    const Eigen::Vector3d a = mesh.nodes.row(mesh.boundary(i, 0)).transpose();
    const Eigen::Vector3d b = mesh.nodes.row(mesh.boundary(i, 1)).transpose();
    const Eigen::Vector3d c = mesh.nodes.row(mesh.boundary(i, 2)).transpose();
    const double area = 0.5 * (b - a).cross(c - a).norm();
    slack += area * options.facet_distance * size_at(size, (a + b + c) / 3.0);
  }
  const double volume = enclosed_volume(surface);
  if (std::abs(quality.volume - volume) > slack + 1e-6 * volume)
    throw MeshError("the mesh has the volume " + std::to_string(quality.volume * 1e9) +
                    " mm³ where the surface encloses " + std::to_string(volume * 1e9) + " mm³");
  check_face_areas(mesh, surface);
}

// One mesh at the given size; boundary_face holds patches.
TetMesh mesh_once(const PreparedSurface& prepared, const SizeField& size,
                  const MeshOptions& options, Attempt attempt, MeshWatch& watch) {
  LinearTets tets = delaunay_mesh(prepared, size, options, attempt, watch);
  const int crumbs = remove_crumbs(tets, kCrumb);
  const int peeled = peel_flat_tets(tets, options.flat_angle, kStraightAngle);
  improve_tets(tets, options.sliver_angle, prepared.oracle, watch);
  TetMesh mesh = to_quadratic(tets, prepared.surface.face_names);
  mesh.report = {prepared.simplified.collapsed, prepared.simplified.distance, crumbs, peeled,
                 watch.questions()};
  return mesh;
}

// The first mesh that the keeper accepts.
TetMesh accepted_mesh(const PreparedSurface& prepared, TopologyKeeper& keeper,
                      const MeshOptions& options, MeshWatch& watch) {
  for (;;) try {
      TetMesh mesh = mesh_once(prepared, keeper.size(), options, keeper.attempt(), watch);
      if (keeper.accepts(mesh)) return mesh;
    } catch (const MeshBreakdown& error) {
      keeper.retry(error.what());
    } catch (const MeshLimitError& error) {
      throw MeshLimitError(keeper.explain(error.what()));
    }
}

}  // namespace

TetMesh tetrahedralize(const SurfaceMesh& input, const SizeField& size,
                       const MeshOptions& options) {
  check_options(options);
  check_size_field(size);
  MeshWatch watch(options);
  const PreparedSurface prepared = prepare_surface(input, size, options);
  watch.require_affordable(prepared.surface, size);
  TopologyKeeper keeper(prepared, size, options);
  TetMesh mesh = accepted_mesh(prepared, keeper, options, watch);
  if (options.curved)
    curve_edges(mesh, mesh.boundary_face, prepared.surface, prepared.lines, prepared.oracle, watch);
  for (int& label : mesh.boundary_face)
    label = prepared.patches.face[static_cast<std::size_t>(label)];
  check_against_surface(mesh, prepared.surface, keeper.size(), options);
  keeper.report(mesh);
  return mesh;
}

}  // namespace codesign::fem
