#include <pybind11/eigen.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <optional>

#include "bindings/bindings.hpp"
#include "bindings/views.hpp"
#include "errors.hpp"
#include "fem/meshing/mesh_options.hpp"
#include "fem/smoothing/surface_smooth.hpp"
#include "fem/surface/bodies.hpp"
#include "fem/surface/mass_properties.hpp"
#include "fem/surface/self_intersection.hpp"
#include "fem/surface/solid_oracle.hpp"
#include "fem/surface/stl.hpp"
#include "fem/surface/surface_check.hpp"
#include "fem/surface/surface_features.hpp"

namespace py = pybind11;
using py::literals::operator""_a;

namespace codesign {

namespace {

using namespace fem;  // NOLINT: the whole file binds this namespace

SurfaceMesh make_surface(const Points& points, const Triangles& triangles,
                         std::optional<std::vector<int>> face,
                         std::optional<std::vector<std::string>> face_names) {
  if (face.has_value() != face_names.has_value())
    throw std::invalid_argument("face and face_names: give both or none");
  SurfaceMesh surface{points, triangles, {}, {""}};
  surface.face.assign(static_cast<std::size_t>(triangles.rows()), 0);
  if (face) surface.face = *face;
  if (face_names) surface.face_names = *face_names;
  check_arrays(surface);
  return surface;
}

SurfaceMesh load_surface(const std::filesystem::path& file, double scale,
                         double feature_angle_deg) {
  SurfaceMesh surface = read_stl(file.string(), scale);
  try {
    check_surface(surface);
    check_self_intersection(surface);
  } catch (const MeshError& e) {
    throw MeshError(file.string() + ": " + e.what());
  }
  label_by_angle(surface, feature_angle_deg * kDegree);
  return surface;
}

void check_solid(const SurfaceMesh& surface) {
  check_surface(surface);
  check_self_intersection(surface);
  check_one_body(surface, find_patches(surface, MeshOptions{}.feature_angle));
}

SurfaceMesh labeled_by_angle(SurfaceMesh surface, double feature_angle_deg) {
  label_by_angle(surface, feature_angle_deg * kDegree);
  return surface;
}

double largest_distance(const SurfaceMesh& surface, const SurfaceMesh& other) {
  if (other.triangles.rows() == 0) throw std::invalid_argument("other: there is no triangle");
  const SolidOracle oracle(other, other.face);
  double largest = 0.0;
  for (Eigen::Index i = 0; i < surface.points.rows(); ++i) {
    const Eigen::Vector3d p = surface.points.row(i).transpose();
    largest = std::max(largest, (oracle.nearest(p, -1).point - p).norm());
  }
  return largest;
}

void bind_surface_mesh(py::module_& m) {
  py::class_<SurfaceMesh>(m, "SurfaceMesh", R"(Triangles that belong to named faces, in meters.

Args:
    points: (n, 3) m.
    triangles: (m, 3) indices, counter-clockwise seen from outside.
    face: (m,) index into face_names; one unnamed face if absent.
    face_names: names, "" for an unnamed face.

Raises:
    ValueError: sizes or indices that do not fit; a name given twice.
    MeshError: a coordinate that is not finite.)")
      .def(py::init(&make_surface), "points"_a, "triangles"_a, "face"_a = py::none(),
           "face_names"_a = py::none())
      .def_readonly("points", &SurfaceMesh::points, "(n, 3) m")
      .def_readonly("triangles", &SurfaceMesh::triangles, "(m, 3)")
      .def_property_readonly(
          "face", [](py::object self) { return view(self.cast<const SurfaceMesh&>().face, self); },
          "(m,) index into face_names")
      .def_readonly("face_names", &SurfaceMesh::face_names)
      .def("__repr__", [](const SurfaceMesh& surface) {
        return py::str("SurfaceMesh({} points, {} triangles, {} faces)")
            .format(surface.points.rows(), surface.triangles.rows(), surface.face_names.size());
      });
  m.def(
      "read_stl",
      [](const std::filesystem::path& file, double scale) {
        return read_stl(file.string(), scale);
      },
      "path"_a, "scale"_a = 1.0, py::call_guard<py::gil_scoped_release>(),
      R"(The triangles of an STL file as they are, in meters, under one unnamed face: not checked.

Raises:
    MeshError: unreadable, truncated, another format, not finite, empty, huge.)");
  m.def("check_surface", &check_solid, "surface"_a, py::call_guard<py::gil_scoped_release>(),
        R"(Checks that a surface bounds one solid, with or without cavities.

Raises:
    MeshError: open, inside-out, not manifold, crossing itself, several bodies; the message says
        what, where and why.)");
  m.def(
      "label_by_angle", &labeled_by_angle, "surface"_a, "feature_angle_deg"_a = 40.0,
      py::call_guard<py::gil_scoped_release>(),
      "The surface with one unnamed face for each piece bounded by edges sharper than the angle.");
  m.def("largest_distance", &largest_distance, "surface"_a, "other"_a,
        py::call_guard<py::gil_scoped_release>(),
        "Largest distance of a point of one surface from the triangles of another. [m]");
  m.def("load_surface", &load_surface, "path"_a, "scale"_a = 1.0, py::kw_only(),
        "feature_angle_deg"_a = 40.0, py::call_guard<py::gil_scoped_release>(),
        R"(Closed surface of an STL file, binary or ASCII, in meters.

Args:
    path: the file.
    scale: meters per unit of the file; 1e-3 for millimeters.
    feature_angle_deg: edges sharper than this bound the (unnamed) faces.

Raises:
    MeshError: unreadable, truncated, not finite, empty, huge, open, inside-out, not manifold,
        self-intersecting; the message says what, where and why.)");
}

std::pair<SurfaceMesh, SmoothReport> smooth(const SurfaceMesh& surface, double feature_angle_deg) {
  SmoothSurface result = smooth_surface(surface, feature_angle_deg * kDegree);
  return {std::move(result.surface), std::move(result.report)};
}

void bind_smooth(py::module_& m) {
  py::class_<SmoothReport>(m, "SmoothReport", "What smooth_surface did.")
      .def_readonly("facets", &SmoothReport::facets, "triangles replaced by curved ones")
      .def_readonly("max_distance", &SmoothReport::max_distance,
                    "m, of a new point from its place on the triangle replaced")
      .def_readonly("volume_change", &SmoothReport::volume_change, "relative")
      .def_readonly("left", &SmoothReport::left,
                    "triangles left as they are lest the surface folds or crosses itself")
      .def_readonly("reason", &SmoothReport::reason,
                    "why the surface is returned unchanged; empty otherwise");
  m.def("smooth_surface", &smooth, "surface"_a, "feature_angle_deg"_a = 40.0,
        py::call_guard<py::gil_scoped_release>(),
        R"(The smooth surface that a coarse tessellation was made from, in finer triangles.

The points of a CAD tessellation lie on the true surface: facets that meet at less than the feature
angle and belong to an arc are curved back, sharp edges between them and the outlines of flat faces
become round. Flat faces keep their plane, all points stay, each piece has the face of its triangle.

Args:
    surface: closed, outward-oriented.
    feature_angle_deg: edges sharper than this are edges of the solid; between 0 and 90.

Returns:
    The surface, and a SmoothReport; the surface as given if nothing is curved, or if it would cross
    itself (`report.reason`).

Raises:
    MeshError: the surface bounds no solid.
    ValueError: the angle is out of range.

Source: Vlachos et al., Curved PN Triangles, I3D 2001, with normals fitted to the chords.)");
}

void bind_mass_properties(py::module_& m) {
  py::class_<MassProperties>(m, "MassProperties", "Mass, center of mass and inertia of a solid.")
      .def_readonly("volume", &MassProperties::volume, "m³")
      .def_readonly("mass", &MassProperties::mass, "kg")
      .def_readonly("com", &MassProperties::com, "(3,) m, axes of the surface")
      .def_readonly("inertia", &MassProperties::inertia,
                    "(3, 3) kg m² about the center of mass, axes of the surface");
  m.def("mass_properties", &mass_properties, "surface"_a, "density"_a,
        py::call_guard<py::gil_scoped_release>(),
        R"(Mass, center of mass and inertia of the polyhedron inside a closed surface.

Args:
    surface: closed and outward-oriented.
    density: kg/m³, positive.

Raises:
    MeshError: the surface bounds no solid.
    ValueError: density is not positive.)");
}

}  // namespace

void bind_surface(py::module_& m) {
  bind_surface_mesh(m);
  bind_smooth(m);
  bind_mass_properties(m);
}

}  // namespace codesign
