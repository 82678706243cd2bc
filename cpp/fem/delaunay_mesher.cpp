// The only file that sees CGAL's mesher.
#include "fem/delaunay_mesher.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Polyhedral_mesh_domain_with_features_3.h>
#include <CGAL/Random.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/properties_Surface_mesh_features.h>
#include <CGAL/make_mesh_3.h>
#include <time.h>

#include <algorithm>
#include <set>
#include <string>
#include <unordered_map>

#include "errors.hpp"

namespace codesign::fem {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Polyhedron = CGAL::Surface_mesh<Kernel::Point_3>;
using Domain = CGAL::Polyhedral_mesh_domain_with_features_3<Kernel, Polyhedron>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation, Domain::Corner_index,
                                                        Domain::Curve_index>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

double thread_seconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// Stops a run that takes too long. The mesher asks for the wanted size in all of its loops, so the
// size field is where the clock is read.
struct Watch {
  double deadline, limit;
  unsigned calls = 0;

  void check() {
    if ((++calls & 0x3FF) == 0 && thread_seconds() > deadline) stop();
  }
  [[noreturn]] void stop() const {
    throw MeshError("meshing was stopped after " + std::to_string(limit) +
                    " s (time_limit): a larger edge length or a cleaner surface is needed");
  }
};

struct SizingField {
  using FT = Kernel::FT;
  using Point_3 = Kernel::Point_3;
  using Index = Domain::Index;

  const SizeField* field;
  Watch* watch;
  double factor;

  FT operator()(const Point_3& p, int, const Index&) const {
    watch->check();
    return factor * size_at(*field, {p.x(), p.y(), p.z()});
  }
};

Polyhedron to_polyhedron(const SurfaceMesh& surface, const Patches& patches) {
  Polyhedron polyhedron;
  polyhedron.reserve(static_cast<unsigned>(surface.points.rows()),
                     static_cast<unsigned>(3 * surface.triangles.rows()),
                     static_cast<unsigned>(surface.triangles.rows()));
  auto patch = get(CGAL::face_patch_id_t<int>(), polyhedron);
  std::vector<Polyhedron::Vertex_index> vertex;
  for (Eigen::Index i = 0; i < surface.points.rows(); ++i)
    vertex.push_back(
        polyhedron.add_vertex({surface.points(i, 0), surface.points(i, 1), surface.points(i, 2)}));
  const auto at = [&](int i) { return vertex[static_cast<std::size_t>(i)]; };
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t) {
    const auto face = polyhedron.add_face(at(surface.triangles(t, 0)), at(surface.triangles(t, 1)),
                                          at(surface.triangles(t, 2)));
    if (face == Polyhedron::null_face())
      throw MeshError("triangle " + std::to_string(t) +
                      " does not fit: the surface touches itself at a point or an edge");
    put(patch, face, patches.of_triangle[static_cast<std::size_t>(t)] + 1);
  }
  return polyhedron;
}

struct Line {
  std::vector<Kernel::Point_3> points;
  std::set<int> patches;
};

struct PointsOfLine {
  using key_type = Line;
  using value_type = std::vector<Kernel::Point_3>;
  using reference = const value_type&;
  using category = boost::readable_property_map_tag;
  friend reference get(PointsOfLine, const Line& line) { return line.points; }
};

struct PatchesOfLine {
  using key_type = Line;
  using value_type = std::set<int>;
  using reference = const value_type&;
  using category = boost::readable_property_map_tag;
  friend reference get(PatchesOfLine, const Line& line) { return line.patches; }
};

void add_lines(const SurfaceMesh& surface, const Patches& patches, Domain& domain) {
  std::vector<Line> lines;
  for (const FeatureLine& feature : find_feature_lines(surface, patches)) {
    Line line;
    for (const int i : feature.points)
      line.points.emplace_back(surface.points(i, 0), surface.points(i, 1), surface.points(i, 2));
    for (const int p : feature.patches) line.patches.insert(p + 1);
    lines.push_back(std::move(line));
  }
  domain.add_features_and_incidences(lines.begin(), lines.end(), PointsOfLine{}, PatchesOfLine{});
}

// Changes weights of vertices so that slivers give way to better elements.
void exude(Complex& complex, const MeshOptions& options, Watch& watch) {
  namespace set = CGAL::parameters;
  if (options.sliver_angle <= 0.0) return;
  const double left = watch.deadline - thread_seconds();
  if (left <= 0.0) watch.stop();
  const CGAL::Mesh_optimization_return_code code = CGAL::exude_mesh_3(
      complex, set::sliver_bound = options.sliver_angle / kDegree, set::time_limit = left);
  if (code == CGAL::TIME_LIMIT_REACHED) watch.stop();
}

LinearTets extract(const Complex& complex) {
  LinearTets mesh;
  std::unordered_map<const void*, int> index;
  for (auto cell = complex.cells_in_complex_begin(); cell != complex.cells_in_complex_end();
       ++cell) {
    std::array<int, 4> tet;
    for (int k = 0; k < 4; ++k) {
      const auto vertex = cell->vertex(k);
      const auto [at, fresh] = index.try_emplace(&*vertex, static_cast<int>(mesh.points.size()));
      if (fresh) {
        const auto& p = vertex->point();
        mesh.points.emplace_back(p.x(), p.y(), p.z());
      }
      tet[static_cast<std::size_t>(k)] = at->second;
    }
    mesh.tets.push_back(tet);
    std::array<int, 4> labels;
    for (int k = 0; k < 4; ++k) {
      const bool inside = complex.is_in_complex(cell->neighbor(k));
      labels[static_cast<std::size_t>(k)] = inside ? -1 : cell->surface_patch_index(k) - 1;
    }
    mesh.side_label.push_back(labels);
  }
  return mesh;
}

}  // namespace

LinearTets delaunay_mesh(const SurfaceMesh& surface, const Patches& patches, const SizeField& size,
                         const MeshOptions& options) {
  CGAL::get_default_random() = CGAL::Random(0);  // the same mesh in every run
  Watch watch{thread_seconds() + options.time_limit, options.time_limit};
  const SizingField length{&size, &watch, 1.0};
  const SizingField distance{&size, &watch, options.facet_distance};
  CGAL::Mesh_error_code error = CGAL::CGAL_MESH_3_NO_ERROR;
  try {
    CGAL::Random random(0);
    Domain domain(to_polyhedron(surface, patches), &random);
    add_lines(surface, patches, domain);
    namespace set = CGAL::parameters;
    const Criteria criteria(
        set::edge_size = length, set::facet_size = length,
        set::facet_angle = options.facet_angle / kDegree, set::facet_distance = distance,
        set::cell_radius_edge_ratio = options.radius_edge, set::cell_size = length);
    CGAL::parameters::internal::Mesh_3_options control;
    control.maximal_number_of_vertices = options.max_vertices;
    control.pointer_to_error_code = &error;
    Complex complex;
    CGAL::make_mesh_3_impl(complex, domain, criteria, set::no_exude(), set::no_perturb(),
                           set::no_odt(), set::no_lloyd(), true, control);
    if (error == CGAL::CGAL_MESH_3_MAXIMAL_NUMBER_OF_VERTICES_REACHED)
      throw MeshError("the mesh would need more than " + std::to_string(options.max_vertices) +
                      " vertices (max_vertices): a larger edge length is needed");
    exude(complex, options, watch);
    return extract(complex);
  } catch (const CGAL::Failure_exception& e) {
    throw MeshError(std::string("the mesher broke down: ") + e.what());
  }
}

}  // namespace codesign::fem
