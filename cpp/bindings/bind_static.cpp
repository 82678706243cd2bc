#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "bindings/bindings.hpp"
#include "fem/boundary/smooth_patch.hpp"
#include "fem/elasticity/static_solver.hpp"
#include "fem/elasticity/unit_responses.hpp"

namespace py = pybind11;
using py::literals::operator""_a;

namespace codesign {

namespace {

using namespace fem;  // NOLINT: the whole file binds this namespace

void bind_material(py::module_& m) {
  py::class_<Material>(m, "Material", "Linear elastic, isotropic material.")
      .def(py::init([](std::string name, double young_modulus, double poisson_ratio, double density,
                       double yield_strength) {
             Material material{std::move(name), young_modulus, poisson_ratio, density,
                               yield_strength};
             check_material(material);
             return material;
           }),
           "name"_a, "young_modulus"_a, "poisson_ratio"_a, "density"_a = 0.0,
           "yield_strength"_a = 0.0)
      .def_readonly("name", &Material::name, "for people")
      .def_readonly("young_modulus", &Material::young_modulus, "Pa")
      .def_readonly("poisson_ratio", &Material::poisson_ratio, "-1 to 0.5")
      .def_readonly("density", &Material::density, "kg/m3")
      .def_readonly("yield_strength", &Material::yield_strength, "Pa")
      .def("__repr__", [](const Material& material) {
        return py::str(
                   "Material({!r}, young_modulus={!r}, poisson_ratio={!r}, density={!r}, "
                   "yield_strength={!r})")
            .format(material.name, material.young_modulus, material.poisson_ratio, material.density,
                    material.yield_strength);
      });
}

void bind_selection(py::module_& m) {
  py::class_<Selection>(m, "Selection")
      .def(py::init<std::vector<std::string>, std::vector<int>, std::vector<int>>(),
           "faces"_a = std::vector<std::string>{}, "triangles"_a = std::vector<int>{},
           "nodes"_a = std::vector<int>{})
      .def_readonly("faces", &Selection::faces)
      .def_readonly("triangles", &Selection::triangles)
      .def_readonly("nodes", &Selection::nodes);
  m.def("selected_triangles", &selected_triangles, "mesh"_a, "selection"_a,
        "Rows of mesh.boundary that a selection holds, sorted.");
  m.def("selected_nodes", &selected_nodes, "mesh"_a, "selection"_a,
        "Nodes that a selection holds, those of its faces included, sorted.");
  py::class_<SmoothPatch>(m, "SmoothPatch", "A piece of one smooth face of a surface.")
      .def_property_readonly(
          "type", [](const SmoothPatch& patch) { return surface_type_name(patch.type); },
          "plane, cylinder, cone, sphere or free")
      .def_readonly("triangles", &SmoothPatch::triangles, "sorted");
  m.def("nearest_triangle", &nearest_triangle, "surface"_a, "point"_a,
        "Index of the triangle of a SurfaceMesh nearest to a point, m.");
  m.def("smooth_patch", &smooth_patch, "surface"_a, "start"_a, "max_bend"_a,
        "The plane, cylinder, cone, sphere or free face that a triangle of a SurfaceMesh belongs "
        "to.");
  m.def("boundary_surface", &boundary_surface, "mesh"_a,
        "The boundary of a TetMesh as a SurfaceMesh of flat triangles.");
  m.def("triangles_near", &triangles_near, "mesh"_a, "point"_a, "max_bend"_a);
  m.def("triangles_in_box", &triangles_in_box, "mesh"_a, "lower"_a, "upper"_a);
  m.def("triangles_with_normal", &triangles_with_normal, "mesh"_a, "normal"_a, "angle"_a);
  m.def("face_area", &face_area, "mesh"_a, "triangles"_a, "Area of curved boundary faces, m2.");
}

// The class of a kind of load: a constructor that takes all members, and the members.
template <typename Kind>
void bind_load(py::module_& m) {
  std::apply(
      [&](auto... member) {
        py::class_<Kind> kind(m, Kind::kName);
        kind.def(py::init([](typename decltype(member)::Type... value) {
                   return Kind{std::move(value)...};
                 }),
                 py::arg(member.name)...);
        (kind.def_readonly(member.name, member.place, member.unit), ...);
      },
      Kind::kMembers);
}

template <typename... Kinds>
void bind_loads(py::module_& m, const std::variant<Kinds...>*) {
  (bind_load<Kinds>(m), ...);
}

void bind_supports_and_loads(py::module_& m) {
  py::class_<Support>(m, "Support")
      .def(py::init<Selection, std::array<bool, 3>, Points, bool>(), "where"_a,
           "fixed"_a = std::array<bool, 3>{true, true, true}, "displacement"_a = Points(0, 3),
           "symmetry"_a = false)
      .def_readonly("where", &Support::where)
      .def_readonly("fixed", &Support::fixed)
      .def_readonly("symmetry", &Support::symmetry);
  py::class_<Disc>(m, "Disc").def(py::init<Eigen::Vector3d, Eigen::Vector3d, double>(), "center"_a,
                                  "axis"_a, "radius"_a);
  py::class_<Plane>(m, "Plane")
      .def(py::init<Eigen::Vector3d, Eigen::Vector3d>(), "point"_a, "normal"_a);
  bind_loads(m, static_cast<const Load*>(nullptr));
  m.def("load_vector", &load_vector, "mesh"_a, "material"_a, "loads"_a,
        py::call_guard<py::gil_scoped_release>());
}

void bind_masses(py::module_& m) {
  py::class_<RemoteMass>(m, "RemoteMass", "A rigid body that is carried by faces of a part.")
      .def(py::init<Selection, double, Eigen::Vector3d, Eigen::Matrix3d, std::optional<Disc>,
                    std::optional<Plane>>(),
           "where"_a, "mass"_a, "position"_a, "inertia"_a, "region"_a = std::nullopt,
           "mirror"_a = std::nullopt)
      .def_readonly("mass", &RemoteMass::mass)
      .def_readonly("position", &RemoteMass::position);
}

void bind_result(py::module_& m) {
  py::enum_<LinearSolver>(m, "LinearSolver")
      .value("automatic", LinearSolver::automatic)
      .value("direct", LinearSolver::direct)
      .value("iterative", LinearSolver::iterative);
  py::enum_<ExclusionRule>(m, "ExclusionRule")
      .value("local", ExclusionRule::local)
      .value("published", ExclusionRule::published);
  py::class_<LeftOut>(m, "LeftOut", "Largest von Mises stress that the exclusion leaves out.")
      .def_readonly("stress", &LeftOut::stress, "Pa; 0: nothing is left out")
      .def_readonly("position", &LeftOut::position, "(3) m")
      .def_readonly("border_distance", &LeftOut::border_distance,
                    "m, from the nearest border of a clamp or load");
  py::class_<StaticSettings>(m, "StaticSettings")
      .def(py::init<>())
      .def_readwrite("exclusion", &StaticSettings::exclusion)
      .def_readwrite("exclusion_distance", &StaticSettings::exclusion_distance,
                     "m, everywhere; None: that of the rule")
      .def_readwrite("stress_volume", &StaticSettings::stress_volume)
      .def_readwrite("copies", &StaticSettings::copies)
      .def_readwrite("residual_tolerance", &StaticSettings::residual_tolerance)
      .def_readwrite("solver", &StaticSettings::solver)
      .def_readwrite("memory_limit", &StaticSettings::memory_limit,
                     "bytes for matrices and factors")
      .def_readwrite("eigenvalues", &StaticSettings::eigenvalues,
                     "modes that will be asked for: the automatic choice leaves them room");
  py::class_<StaticResult>(m, "StaticResult", "Displacement, stress and safety factor of a part.")
      .def_readonly("displacement", &StaticResult::displacement, "(n, 3) m")
      .def_readonly("stress", &StaticResult::stress, "(n, 6) Pa: xx yy zz xy yz zx")
      .def_readonly("von_mises", &StaticResult::von_mises, "(n) Pa")
      .def_readonly("reactions", &StaticResult::reactions, "(n, 3) N, supports on the part")
      .def_readonly("support_forces", &StaticResult::support_forces, "(supports, 3) N")
      .def_readonly("work", &StaticResult::work, "J, load times displacement")
      .def_readonly("strain_energy", &StaticResult::strain_energy, "J")
      .def_readonly("max_displacement", &StaticResult::max_displacement, "m")
      .def_readonly("peak_stress", &StaticResult::peak_stress, "Pa")
      .def_readonly("peak_position", &StaticResult::peak_position, "(3) m")
      .def_readonly("border_distance", &StaticResult::border_distance,
                    "m, of peak_position from the nearest border of a clamp or load")
      .def_readonly(
          "peak_at_exclusion", &StaticResult::peak_at_exclusion,
          "True if the peak lies right beside larger stresses that the exclusion leaves out")
      .def_readonly("stress_error", &StaticResult::stress_error,
                    "Pa, estimated error of peak_stress")
      .def_readonly("energy_error", &StaticResult::energy_error,
                    "estimated relative error in the energy norm")
      .def_readonly("element_error", &StaticResult::element_error,
                    "(m) Pa, difference of element and recovered stress")
      .def_readonly("stress_50", &StaticResult::stress_50, "Pa")
      .def_readonly("safety_factor", &StaticResult::safety_factor,
                    "yield strength over peak_stress; inf if nothing is stressed")
      .def_readonly("counts_for_peak", &StaticResult::counts_for_peak,
                    "(n) False where the peak stress is not read")
      .def_readonly("left_out", &StaticResult::left_out, "LeftOut")
      .def_readonly("exclusion_smallest", &StaticResult::exclusion_smallest,
                    "m, of the distances kept from borders")
      .def_readonly("exclusion_largest", &StaticResult::exclusion_largest, "m")
      .def_property_readonly("peak_resolved", &StaticResult::peak_resolved,
                             "False if the estimated error exceeds half of the peak stress")
      .def_readonly("residual", &StaticResult::residual, "relative, over the free components")
      .def_readonly("equations", &StaticResult::equations, "free components of displacement")
      .def_readonly("iterations", &StaticResult::iterations,
                    "of conjugate gradients; 0: solved by the factor");
  py::class_<NaturalModes>(m, "NaturalModes", "Free vibration of a part.")
      .def_readonly("frequency", &NaturalModes::frequency,
                    "(k,) Hz, ascending; 0 for rigid motions")
      .def_readonly("shape", &NaturalModes::shape, "(3 n, k) columns, modal mass 1 kg");
  py::class_<BucklingModes>(m, "BucklingModes", "Linear buckling of a part under a load.")
      .def_readonly("factor", &BucklingModes::factor, "(k,) of the load, > 0, ascending")
      .def_readonly("shape", &BucklingModes::shape, "(3 n, k) columns, the largest node moves 1")
      .def_readonly("reversed", &BucklingModes::reversed,
                    "lowest factor of the load reversed; inf: none")
      .def_readonly("limit", &BucklingModes::limit, "factor up to which was sought");
  py::class_<HistoryPeak>(m, "HistoryPeak", "Largest von Mises stress over a history of loads.")
      .def_property_readonly(
          "stress", [](const HistoryPeak& found) { return found.peak.value; }, "Pa")
      .def_property_readonly(
          "position", [](const HistoryPeak& found) { return found.peak.position; }, "(3) m")
      .def_readonly("instant", &HistoryPeak::instant, "row of the history")
      .def_readonly("pairs", &HistoryPeak::pairs, "of a face or element and a block of instants")
      .def_readonly("visited", &HistoryPeak::visited, "pairs that no bound ruled out");
  py::class_<UnitResponses>(m, "UnitResponses", "Answers of a part to unit loads.")
      .def_property_readonly("units", &UnitResponses::units, "how many unit loads")
      .def_property_readonly("mesh", &UnitResponses::mesh, "TetMesh")
      .def("peak", &UnitResponses::peak, "history"_a, py::call_guard<py::gil_scoped_release>(),
           "Largest von Mises stress over a history (instants, units) of the units' factors.")
      .def("at", &UnitResponses::at, "factors"_a, py::call_guard<py::gil_scoped_release>(),
           "StaticResult of one instant, factors (units,).")
      .def_property_readonly("stress", &UnitResponses::stress,
                             "(n, 6 units) Pa at the nodes: xx yy zz xy yz zx of each unit load");
  py::class_<StaticSystem>(m, "StaticSystem", "A model factorized once for many load cases.")
      .def(py::init<TetMesh, Material, std::vector<Support>, StaticSettings,
                    std::vector<RemoteMass>>(),
           "mesh"_a, "material"_a, "supports"_a, "settings"_a,
           "masses"_a = std::vector<RemoteMass>{}, py::call_guard<py::gil_scoped_release>())
      .def("solve", &StaticSystem::solve, "loads"_a, py::call_guard<py::gil_scoped_release>())
      .def("unit_responses", &StaticSystem::unit_responses, "units"_a,
           py::call_guard<py::gil_scoped_release>())
      .def("displacement", &StaticSystem::displacement, "loads"_a,
           py::call_guard<py::gil_scoped_release>(), "(n, 3) m, of one load case")
      .def("natural_modes", &StaticSystem::natural_modes, "count"_a,
           py::call_guard<py::gil_scoped_release>())
      .def("buckling_modes", &StaticSystem::buckling_modes, "displacement"_a, "count"_a,
           py::call_guard<py::gil_scoped_release>());
  m.def("natural_modes", &natural_modes, "mesh"_a, "material"_a, "supports"_a, "count"_a,
        "memory_limit"_a = kMemoryLimit, "masses"_a = std::vector<RemoteMass>{},
        py::call_guard<py::gil_scoped_release>());
}

}  // namespace

void bind_static(py::module_& m) {
  bind_material(m);
  bind_selection(m);
  bind_supports_and_loads(m);
  bind_masses(m);
  bind_result(m);
}

}  // namespace codesign
