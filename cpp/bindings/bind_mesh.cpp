#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <map>
#include <optional>
#include <variant>

#include "bindings/bindings.hpp"
#include "bindings/views.hpp"
#include "errors.hpp"
#include "fem/mesh/mesh_quality.hpp"
#include "fem/mesh/tet_topology.hpp"
#include "fem/meshing/size_field.hpp"
#include "fem/meshing/tet_mesher.hpp"
#include "fem/meshing/wall_size.hpp"

namespace py = pybind11;
using py::literals::operator""_a;

namespace codesign {

namespace {

using namespace fem;  // NOLINT: the whole file binds this namespace

void bind_size_field(py::module_& m) {
  py::class_<SizeSource>(m, "SizeSource", R"(A polyline near which elements are small.

Args:
    points: (k, 3) m; one row is a point.
    size: edge length within `radius` of the polyline [m].
    growth: increase of the edge length per meter of distance beyond `radius`.
    radius: m.)")
      .def(py::init<Points, double, double, double>(), "points"_a, "size"_a, "growth"_a = 0.5,
           "radius"_a = 0.0)
      .def_readonly("points", &SizeSource::points, "(k, 3) m")
      .def_readonly("size", &SizeSource::size, "m")
      .def_readonly("growth", &SizeSource::growth, "of the edge length per distance")
      .def_readonly("radius", &SizeSource::radius, "m");
  py::class_<SizeField>(m, "SizeField", R"(Edge length wanted at each point.

min(base, size + growth * max(0, distance - radius)) over all sources; meters.)")
      .def(py::init([](double base, std::vector<SizeSource> sources) {
             SizeField field{base, std::move(sources)};
             check_size_field(field);
             return field;
           }),
           "base"_a, "sources"_a = std::vector<SizeSource>{})
      .def_readonly("base", &SizeField::base, "m")
      .def_readonly("sources", &SizeField::sources, "list of SizeSource")
      .def("scaled", &scaled, "factor"_a,
           "The field with all edge lengths times a positive factor.")
      .def_property_readonly("smallest", &smallest_size, "m, the smallest edge length anywhere")
      .def(
          "__call__",
          [](const SizeField& field, const Points& points) {
            Eigen::VectorXd sizes(points.rows());
            for (Eigen::Index i = 0; i < points.rows(); ++i)
              sizes[i] = size_at(field, points.row(i).transpose());
            return sizes;
          },
          "points"_a, "Edge length [m] at points (k, 3) m.");
}

template <class Tets>
TetMesh make_mesh(const Points& nodes, const Tets& tets,
                  const std::map<std::string, Triangles>& faces) {
  TetMesh mesh = make_tet_mesh(nodes, tets);
  std::vector<NamedSides> named;
  for (const auto& [name, sides] : faces) named.push_back({name, sides});
  name_faces(mesh, named);
  return mesh;
}

void bind_quality(py::module_& m) {
  py::class_<MeshQuality>(m, "MeshQuality", "Shape of the tetrahedra between their corners.")
      .def_property_readonly(
          "min_dihedral_deg", [](const MeshQuality& q) { return q.min_dihedral / kDegree; },
          "degrees")
      .def_property_readonly(
          "max_dihedral_deg", [](const MeshQuality& q) { return q.max_dihedral / kDegree; },
          "degrees")
      .def_readonly("min_radius_ratio", &MeshQuality::min_radius_ratio,
                    "3 inscribed / circumscribed radius; 1 regular, 0 flat")
      .def_readonly("mean_radius_ratio", &MeshQuality::mean_radius_ratio, "1 if all are regular")
      .def_readonly("worst_tet", &MeshQuality::worst_tet, "of the smallest dihedral angle")
      .def_readonly("below_5_degrees", &MeshQuality::below_5_degrees,
                    "elements with a dihedral angle below 5 degrees")
      .def_readonly("volume", &MeshQuality::volume, "m³")
      .def_readonly("area", &MeshQuality::area, "m²");
}

void bind_report(py::module_& m) {
  py::class_<MeshReport>(m, "MeshReport", "What was done to get a sound mesh.")
      .def_readonly("collapsed", &MeshReport::collapsed, "short edges of the surface")
      .def_readonly("collapse_distance", &MeshReport::collapse_distance,
                    "m, the farthest that a point of the surface moved for that")
      .def_readonly("crumbs", &MeshReport::crumbs,
                    "elements removed that hung on the mesh by a point or an edge")
      .def_readonly("peeled", &MeshReport::peeled, "flat boundary elements removed")
      .def_readonly("refinements", &MeshReport::refinements,
                    "rounds of smaller elements that the surface's topology asked for")
      .def_readonly(
          "small_faults", &MeshReport::small_faults,
          "places of at most 0.05 mm and 0.0005 of the extent where the boundary touches itself, "
          "on ledges that no element follows; the solid has the topology of the surface")
      .def_readonly("genus", &MeshReport::genus,
                    "of each closed piece of the surface, and of the solid")
      .def_property_readonly(
          "surface_distance",
          [](const MeshReport& report) {
            return report.surface_distance < 0.0 ? std::optional<double>()
                                                 : std::optional(report.surface_distance);
          },
          "m, largest between boundary and surface, both ways; None if not measured")
      .def_readonly("questions", &MeshReport::questions,
                    "of the refinement about the solid and the size: its work, on any machine");
}

void bind_tet_mesh(py::module_& m) {
  const std::map<std::string, Triangles> no_faces;
  py::class_<TetMesh>(m, "TetMesh", R"(Ten-node tetrahedra with named boundary faces.

Args:
    nodes: (n, 3) m.
    tets: (m, 4), which get straight mid-edge nodes, or (m, 10) with mid-edge nodes on edges
        01 12 02 03 13 23. Elements given inside out are turned over.
    faces: name -> (k, 3) boundary sides by their corner nodes.

Raises:
    MeshError: flat elements, nodes without element, indices out of range, sides that are not on
        the boundary.)")
      .def(py::init(&make_mesh<Tets10>), "nodes"_a, "tets"_a, "faces"_a = no_faces)
      .def(py::init(&make_mesh<Tets4>), "nodes"_a, "tets"_a, "faces"_a = no_faces)
      .def_readonly("nodes", &TetMesh::nodes, "(n, 3) m")
      .def_readonly("tets", &TetMesh::tets, "(m, 10); mid-edge nodes on 01 12 02 03 13 23")
      .def_readonly("boundary", &TetMesh::boundary, "(b, 6); mid-edge nodes on 01 12 20")
      .def_property_readonly(
          "boundary_face",
          [](py::object self) { return view(self.cast<const TetMesh&>().boundary_face, self); },
          "(b,) index into face_names")
      .def_readonly("face_names", &TetMesh::face_names, "that boundary_face indexes")
      .def_readonly("report", &TetMesh::report, "MeshReport of how it was made")
      .def_property_readonly("quality", &measure_quality, "MeshQuality of the elements")
      .def("__repr__", [](const TetMesh& mesh) {
        return py::str("TetMesh({} nodes, {} tetrahedra)")
            .format(mesh.nodes.rows(), mesh.tets.rows());
      });
}

SizeField default_size(const SurfaceMesh& surface, std::optional<double> edge_length) {
  return wall_size(surface, edge_length ? *edge_length : mean_wall_size(surface));
}

TetMesh make_tets(const SurfaceMesh& surface,
                  const std::optional<std::variant<double, SizeField>>& edge_length,
                  double feature_angle_deg, double simplify, double facet_distance,
                  double facet_angle_deg, double radius_edge, double sliver_angle_deg,
                  double flat_angle_deg, bool curved, double time_limit, std::size_t max_questions,
                  std::size_t max_vertices, bool check_intersections) {
  const SizeField size = !edge_length ? default_size(surface, {})
                         : std::holds_alternative<double>(*edge_length)
                             ? SizeField{std::get<double>(*edge_length), {}}
                             : std::get<SizeField>(*edge_length);
  MeshOptions options;
  options.feature_angle = feature_angle_deg * kDegree;
  options.simplify = simplify;
  options.facet_distance = facet_distance;
  options.facet_angle = facet_angle_deg * kDegree;
  options.radius_edge = radius_edge;
  options.sliver_angle = sliver_angle_deg * kDegree;
  options.flat_angle = flat_angle_deg * kDegree;
  options.curved = curved;
  options.time_limit = time_limit;
  options.max_questions = max_questions;
  options.max_vertices = max_vertices;
  options.check_intersections = check_intersections;
  return tetrahedralize(surface, size, options);
}

void bind_mesher(py::module_& m) {
  const MeshOptions defaults;
  m.attr("MAX_QUESTIONS") = defaults.max_questions;
  m.attr("TIME_LIMIT") = defaults.time_limit;
  m.def("default_size", &default_size, "surface"_a, "edge_length"_a = py::none(),
        py::call_guard<py::gil_scoped_release>(),
        R"(Edge length that follows the local wall thickness.

Where walls or gaps between walls are thin, 0.85 of their thickness; elsewhere `edge_length`; graded
between. Never below a twentieth of `edge_length`, nor so small that more than about 250 000
elements would be needed.

Args:
    surface: closed, outward-oriented.
    edge_length: m, in thick places; from the mean wall thickness and at most about 30 000 elements
        if absent.

Raises:
    MeshError: the surface bounds no solid.
    ValueError: edge_length is not positive.)");
  m.def("tetrahedralize", &make_tets, "surface"_a, "edge_length"_a = py::none(), py::kw_only(),
        "feature_angle_deg"_a = 40.0, "simplify"_a = defaults.simplify,
        "facet_distance"_a = defaults.facet_distance, "facet_angle_deg"_a = 25.0,
        "radius_edge"_a = defaults.radius_edge, "sliver_angle_deg"_a = 12.0,
        "flat_angle_deg"_a = 6.0, "curved"_a = defaults.curved,
        "time_limit"_a = defaults.time_limit, "max_questions"_a = defaults.max_questions,
        "max_vertices"_a = defaults.max_vertices,
        "check_intersections"_a = defaults.check_intersections,
        py::call_guard<py::gil_scoped_release>(),
        R"(Ten-node tetrahedra of the solid inside a closed surface.

Sharp edges and borders between different faces become lines of the mesh, and each boundary side
carries the face of the surface it lies on. The same input gives the same mesh.

Args:
    surface: closed, outward-oriented, one solid.
    edge_length: m, or a SizeField; default_size(surface) if absent. Elements become smaller
        where the boundary would otherwise have another topology than the surface.
    feature_angle_deg: edges sharper than this are kept.
    simplify: points of the surface may move this far [m] to get rid of tiny edges and ledges;
        never more than 0.0005 of its extent and 0.1 of the smallest edge length.
    facet_distance: of boundary sides to the surface, relative to the edge length.
    facet_angle_deg: smallest angle of a boundary side, at most 30.
    radius_edge: largest circumradius over shortest edge, at least 2.
    sliver_angle_deg: elements with a smaller dihedral angle are improved where possible.
    flat_angle_deg: flatter boundary elements on one face are removed.
    curved: mid-edge nodes of the boundary on the surface instead of on straight edges.
    time_limit: processor seconds; a safety net, the next two decide on every machine alike.
    max_questions: of the refinement about the solid and the size (`report.questions`).
    max_vertices: of corner nodes.
    check_intersections: look for triangles that cross each other first.

Raises:
    MeshError: the surface bounds no solid or crosses itself; the mesh is empty, in pieces, of
        another topology or wrong volume.
    MeshLimitError: a limit was reached; the message says which and, if points crowd, where.
    ValueError: an option out of range.)");
}

}  // namespace

void bind_mesh(py::module_& m) {
  bind_size_field(m);
  bind_quality(m);
  bind_report(m);
  bind_tet_mesh(m);
  bind_mesher(m);
}

}  // namespace codesign
