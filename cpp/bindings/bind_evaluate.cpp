#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <map>

#include "bindings/bindings.hpp"
#include "bindings/evaluate.hpp"
#include "fem/kept_meshes.hpp"
#include "fem/la/linked_libraries.hpp"

namespace py = pybind11;
using py::literals::operator""_a;

namespace codesign {

namespace {

fem::PartCase make_case(fem::SurfaceMesh surface, fem::SizeField size, fem::Material material,
                        std::vector<fem::Support> supports, std::vector<fem::LoadCase> cases,
                        const fem::StaticSettings& settings, double facet_angle_deg,
                        double tolerance, int max_refinements) {
  fem::PartCase part;
  part.surface = std::move(surface);
  part.size = std::move(size);
  part.mesh_options.facet_angle = facet_angle_deg * fem::kDegree;
  part.material = std::move(material);
  part.supports = std::move(supports);
  part.cases = std::move(cases);
  part.settings = settings;
  part.tolerance = tolerance;
  part.max_refinements = max_refinements;
  return part;
}

}  // namespace

void bind_evaluate(py::module_& m) {
  py::class_<fem::LoadCase>(m, "LoadCase", "Loads that act together.")
      .def(py::init<std::string, std::vector<fem::Load>, double, bool>(), "name"_a, "loads"_a,
           "least_safety_factor"_a = 1.0, "antisymmetric"_a = false)
      .def_readonly("name", &fem::LoadCase::name)
      .def_readonly("loads", &fem::LoadCase::loads)
      .def_readonly("least_safety_factor", &fem::LoadCase::least_safety_factor)
      .def_readonly("antisymmetric", &fem::LoadCase::antisymmetric);
  py::class_<fem::VaryingCase>(m, "VaryingCase", "Unit loads whose factors vary over time.")
      .def(py::init<std::string, std::vector<std::vector<fem::Load>>>(), "name"_a, "units"_a)
      .def_readonly("name", &fem::VaryingCase::name)
      .def_readonly("units", &fem::VaryingCase::units);
  py::class_<fem::Stretch>(
      m, "Stretch",
      "Makes a body longer or shorter along a unit direction: what lies at most `start` behind the "
      "origin [m] stays, what lies at least `end` behind it moves by `change` [m]. Raises: "
      "ValueError (no unit direction, an empty zone, more than two thirds of it lost).")
      .def(py::init([](const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                       double start, double end, double change) {
             const fem::Stretch stretch{origin, direction, start, end, change};
             fem::check_stretch(stretch);
             return stretch;
           }),
           "origin"_a, "direction"_a, "start"_a, "end"_a, "change"_a)
      .def_readonly("origin", &fem::Stretch::origin, "(3,) m")
      .def_readonly("direction", &fem::Stretch::direction, "(3,) unit vector")
      .def_readonly("start", &fem::Stretch::from, "m along the direction")
      .def_readonly("end", &fem::Stretch::to, "m along the direction")
      .def_readonly("change", &fem::Stretch::change, "m, of the zone's length");
  py::class_<fem::PartCase>(m, "PartCase",
                            "One part and its load cases; supports and loads name surface faces.")
      .def(py::init(&make_case), py::kw_only(), "surface"_a, "size"_a, "material"_a, "supports"_a,
           "cases"_a,
           py::arg_v("settings", fem::StaticSettings{}, "codesign._core.fem.StaticSettings()"),
           "facet_angle_deg"_a = 25.0, "tolerance"_a = fem::PartCase{}.tolerance,
           "max_refinements"_a = 0)
      .def_readonly("surface", &fem::PartCase::surface)
      .def_readwrite("size", &fem::PartCase::size)
      .def_readwrite("stretch", &fem::PartCase::stretch,
                     "Stretch, or None: the part is the surface's body stretched; parts that "
                     "differ by it alone share a mesh and most of its factor")
      .def_readonly("material", &fem::PartCase::material)
      .def_readonly("supports", &fem::PartCase::supports)
      .def_readonly("cases", &fem::PartCase::cases)
      .def_readonly("settings", &fem::PartCase::settings)
      .def_readwrite("tolerance", &fem::PartCase::tolerance, "relative, of the peak stress")
      .def_readwrite("max_refinements", &fem::PartCase::max_refinements, "0: one pass")
      .def_readwrite("varying", &fem::PartCase::varying, "VaryingCase")
      .def_readwrite("masses", &fem::PartCase::masses, "RemoteMass")
      .def_readwrite("modes", &fem::PartCase::modes, "natural frequencies wanted")
      .def_readwrite("buckling", &fem::PartCase::buckling, "buckling factors wanted");
  py::class_<fem::CaseConvergence>(m, "CaseConvergence",
                                   "How far a case's peak is settled by meshes refined around it.")
      .def_readonly("refined", &fem::CaseConvergence::refined, "around its peak, at least once")
      .def_readonly("change", &fem::CaseConvergence::change,
                    "of the peak by the last refinement there, relative; the largest since")
      .def_readonly("settled", &fem::CaseConvergence::settled,
                    "refined, estimated error and change within the tolerance; or no stress");
  py::class_<fem::PartAnalysis>(m, "PartAnalysis", "Mesh, static result and wall-clock times.")
      .def_readonly("mesh", &fem::PartAnalysis::mesh)
      .def_readonly("case_names", &fem::PartAnalysis::case_names)
      .def_readonly("results", &fem::PartAnalysis::results, "StaticResult of every load case")
      .def_readonly("governing", &fem::PartAnalysis::governing,
                    "the case of the smallest safety factor over what it asks for")
      .def_property_readonly("result", &fem::PartAnalysis::result, "of the governing case")
      .def_readonly("responses", &fem::PartAnalysis::responses,
                    "UnitResponses of each varying case")
      .def_readonly("frequencies", &fem::PartAnalysis::frequencies,
                    "(modes,) Hz, ascending, of the whole part")
      .def_readonly("buckling_factors", &fem::PartAnalysis::buckling_factors,
                    "(buckling,) of the load, ascending, of the whole part; inf where there is "
                    "none")
      .def_readonly("size", &fem::PartAnalysis::size, "SizeField of the mesh")
      .def_readonly("converged", &fem::PartAnalysis::converged,
                    "every case is settled; of one pass: estimated error of the governing one "
                    "within the tolerance")
      .def_readonly("refinements", &fem::PartAnalysis::refinements)
      .def_readonly("convergence", &fem::PartAnalysis::convergence,
                    "CaseConvergence of every load case; none if no refinement is allowed")
      .def_readonly("failure", &fem::PartAnalysis::failure,
                    "of a finer mesh that could not be made or solved; empty if all could")
      .def_readonly("stopped", &fem::PartAnalysis::stopped,
                    "why refining ended without convergence; empty otherwise")
      .def_readonly("mesh_seconds", &fem::PartAnalysis::mesh_seconds)
      .def_readonly("solve_seconds", &fem::PartAnalysis::solve_seconds);
  m.def(
      "limit_kept_meshes", &fem::limit_kept_meshes, "bytes"_a,
      "What this process may keep of the meshes and factors of stretched parts, 256 MB at first.");
  m.def("forget_meshes", &fem::forget_meshes,
        "Frees what is kept of stretched parts; whether there was anything.");
  m.def("analyze_part", &fem::analyze_part, "part"_a, py::call_guard<py::gil_scoped_release>(),
        "Surface to safety factor. Raises MeshError, SolverError.");

  py::class_<DesignResult>(m, "DesignResult")
      .def_readonly("parts", &DesignResult::parts, "PartAnalysis in the order of the cases")
      .def_readonly("flights", &DesignResult::flights, "FlightLog, one per seed")
      .def_property_readonly(
          "seconds",
          [](const DesignResult& result) {
            return std::map<std::string, double>{{"fem", result.fem_seconds},
                                                 {"flight", result.flight_seconds}};
          },
          "wall clock");
  m.def(
      "library_versions",
      [] {
        return std::map<std::string, std::string>{{"Eigen", CODESIGN_EIGEN_VERSION},
                                                  {"CGAL", CODESIGN_CGAL_VERSION},
                                                  {"urdfdom", CODESIGN_URDFDOM_VERSION},
                                                  {"compiler", CODESIGN_COMPILER},
                                                  {"build type", CODESIGN_BUILD_TYPE}};
      },
      "What the module was built with.");
  m.def("linked_libraries", &fem::linked_libraries,
        "Versions of the shared libraries that decide digits, as loaded: CHOLMOD, OpenBLAS and its "
        "kernel, C library.");
  m.def("evaluate", &evaluate, "parts"_a, "urdf"_a, "flight"_a, "seeds"_a,
        py::call_guard<py::gil_scoped_release>(),
        "Meshes and solves every part, loads the robot and flies it once for every seed of the "
        "disturbances: the native half of the chain in one call, without the GIL.");
}

}  // namespace codesign
