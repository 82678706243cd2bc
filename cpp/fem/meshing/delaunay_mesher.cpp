// The only file that sees CGAL's mesher. It works on SolidDomain, which answers its questions about
// the solid by our own SolidOracle and FeatureCurve: half the meshing time of CGAL's polyhedral
// domain, whose queries fall back on exact arithmetic (forearm support 0.59 -> 0.30 s).
#include "fem/meshing/delaunay_mesher.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Random.h>
#include <CGAL/make_mesh_3.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "errors.hpp"
#include "fem/mesh/tet_neighbors.hpp"
#include "fem/meshing/ball_size.hpp"
#include "fem/meshing/feature_curve.hpp"
#include "fem/meshing/mesh_watch.hpp"
#include "fem/meshing/spread_triangles.hpp"
#include "fem/surface/solid_oracle.hpp"

namespace codesign::fem {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Vector3d to_vector(const Point& p) { return {p.x(), p.y(), p.z()}; }
Point to_point(const Vector3d& p) { return {p.x(), p.y(), p.z()}; }

// What the concept's optional indices are.
#if CGAL_VERSION_MAJOR >= 6
template <class T>
using Optional = std::optional<T>;
#else
template <class T>
using Optional = boost::optional<T>;
#endif

// CGAL's concept MeshDomainWithFeatures_3. Indices are plain integers: patches from 1, curves and
// corners by their position in the lists; the only subdomain is 1.
class SolidDomain {
 public:
  using R = Kernel;
  using Has_features = CGAL::Tag_true;
  using FT = Kernel::FT;
  using Point_3 = Point;
  using Segment_3 = Kernel::Segment_3;
  using Ray_3 = Kernel::Ray_3;
  using Line_3 = Kernel::Line_3;
  using Vector_3 = Kernel::Vector_3;
  using Sphere_3 = Kernel::Sphere_3;
  using Index = int;
  using Subdomain_index = int;
  using Surface_patch_index = int;
  using Curve_index = int;
  using Corner_index = int;
  using Subdomain = Optional<int>;
  using Surface_patch = Optional<int>;
  using Intersection = std::tuple<Point, int, int>;  // point, patch, dimension (0: none)

  SolidDomain(const SurfaceMesh& surface, const Patches& patches,
              const std::vector<FeatureLine>& lines, const SolidOracle& oracle, MeshWatch& watch)
      : patches_(patches), oracle_(oracle), watch_(watch) {
    std::map<int, int> corner_of;  // point of the surface -> corner
    const auto add_corner = [&](int point) {
      const auto [at, fresh] = corner_of.try_emplace(point, static_cast<int>(corners_.size()));
      if (fresh) corners_.push_back(to_point(surface.points.row(point).transpose()));
      return at->second;
    };
    for (const FeatureLine& line : lines) {
      std::vector<Vector3d> points;
      for (const int i : line.points) points.push_back(surface.points.row(i).transpose());
      curves_.emplace_back(std::move(points));
      const bool closed = line.points.front() == line.points.back();
      ends_.emplace_back(closed && !line.starts_at_corner ? -1 : add_corner(line.points.front()),
                         closed && !line.starts_at_corner ? -1 : add_corner(line.points.back()));
    }
  }

  CGAL::Bbox_3 bbox() const {
    const Vector3d& a = oracle_.lower();
    const Vector3d& b = oracle_.upper();
    return {a.x(), a.y(), a.z(), b.x(), b.y(), b.z()};
  }

  struct Is_in_domain {
    const SolidDomain& domain;
    Subdomain operator()(const Point& p) const {
      domain.watch_.question();
      return domain.oracle_.contains(to_vector(p)) ? Subdomain(1) : Subdomain();
    }
  };
  Is_in_domain is_in_domain_object() const { return {*this}; }

  struct Construct_intersection {
    const SolidDomain& domain;
    Intersection operator()(const Segment_3& s) const {
      // Measured from the end nearer to the solid: the other one may be very far away.
      const Vector3d a = to_vector(s.source()), b = to_vector(s.target());
      const Vector3d middle = 0.5 * (domain.oracle_.lower() + domain.oracle_.upper());
      const bool from_a = (a - middle).squaredNorm() <= (b - middle).squaredNorm();
      return domain.intersection(from_a ? a : b, from_a ? Vector3d(b - a) : Vector3d(a - b), 0.0,
                                 1.0);
    }
    Intersection operator()(const Ray_3& r) const {
      const Vector3d a = to_vector(r.source());
      return domain.intersection(a, to_vector(r.second_point()) - a, 0.0, kInfinity);
    }
    Intersection operator()(const Line_3& l) const {
      const Vector3d a = to_vector(l.point(0));
      return domain.intersection(a, to_vector(l.point(1)) - a, -kInfinity, kInfinity);
    }
  };
  Construct_intersection construct_intersection_object() const { return {*this}; }

  Index index_from_surface_patch_index(int patch) const { return patch; }
  Index index_from_subdomain_index(int subdomain) const { return subdomain; }
  Index index_from_curve_index(int curve) const { return curve; }
  Index index_from_corner_index(int corner) const { return corner; }
  int surface_patch_index(Index index) const { return index; }
  int subdomain_index(Index index) const { return index; }
  int curve_index(Index index) const { return index; }
  int corner_index(Index index) const { return index; }

  template <class Out>
  Out get_corners(Out out) const {
    for (std::size_t i = 0; i < corners_.size(); ++i)
      *out++ = std::pair(static_cast<int>(i) + 1, corners_[i]);
    return out;
  }
  template <class Out>
  Out get_curves(Out out) const {
    for (std::size_t i = 0; i < curves_.size(); ++i) {
      const int index = static_cast<int>(i) + 1;
      const auto [p, q] = ends_[i];
      const std::pair<Point, Index> first(to_point(curves_[i].points().front()),
                                          p < 0 ? index : p + 1);
      const std::pair<Point, Index> last(to_point(curves_[i].points().back()),
                                         q < 0 ? index : q + 1);
      *out++ = std::make_tuple(index, first, last);
    }
    return out;
  }
  bool is_loop(int curve) const { return at(curve).is_closed(); }
  FT curve_length(int curve) const { return at(curve).length(); }
  FT curve_segment_length(const Point& p, const Point& q, int curve,
                          CGAL::Orientation orientation) const {
    return asked(curve).length_between(to_vector(p), to_vector(q), orientation == CGAL::POSITIVE);
  }
  // Positive in the direction of the curve; on a loop of the shorter way. Asked for from CGAL 6 on.
  FT signed_geodesic_distance(const Point& p, const Point& q, int curve) const {
    const FeatureCurve& line = asked(curve);
    const Vector3d from = to_vector(p), to = to_vector(q);
    if (!line.is_closed()) return line.position(to) - line.position(from);
    const double forward = line.length_between(from, to, true);
    const double backward = line.length_between(from, to, false);
    return forward < backward ? forward : -backward;
  }
  Point construct_point_on_curve(const Point& p, int curve, FT distance) const {
    const Vector3d point = asked(curve).point_at(to_vector(p), distance);
    watch_.ball(point);
    return to_point(point);
  }
  CGAL::Sign distance_sign(const Point& p, const Point& q, int curve) const {
    return CGAL::sign(asked(curve).position(to_vector(q)) - asked(curve).position(to_vector(p)));
  }
  CGAL::Sign distance_sign_along_loop(const Point& p, const Point& q, const Point& r,
                                      int curve) const {
    const double pq = asked(curve).length_between(to_vector(p), to_vector(q), true);
    const double pr = asked(curve).length_between(to_vector(p), to_vector(r), true);
    return pq <= pr ? CGAL::POSITIVE : CGAL::NEGATIVE;
  }
  bool is_curve_segment_covered(int curve, CGAL::Orientation orientation, const Point& p,
                                const Point& q, FT squared_radius_p, FT squared_radius_q) const {
    return asked(curve).is_covered(to_vector(p), squared_radius_p, to_vector(q), squared_radius_q,
                                   orientation == CGAL::POSITIVE);
  }

 private:
  const FeatureCurve& at(int curve) const { return curves_[static_cast<std::size_t>(curve - 1)]; }

  const FeatureCurve& asked(int curve) const {
    watch_.question();
    return at(curve);
  }

  Intersection intersection(const Vector3d& base, const Vector3d& direction, double first,
                            double last) const {
    watch_.question();
    const auto piece = oracle_.clip(base, direction, first, last);
    if (!piece) return {};
    const auto hit = oracle_.hit(piece->a, piece->b);
    if (!hit) return {};
    const int patch = patches_.of_triangle[static_cast<std::size_t>(hit->triangle)] + 1;
    return {to_point(hit->point), patch, 2};
  }

  const Patches& patches_;
  const SolidOracle& oracle_;
  MeshWatch& watch_;
  std::vector<Point> corners_;
  std::vector<FeatureCurve> curves_;
  std::vector<std::pair<int, int>> ends_;  // corners at the ends of a curve, -1: none
};

using Triangulation = CGAL::Mesh_triangulation_3<SolidDomain>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation, int, int>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;
using Control = CGAL::parameters::internal::Mesh_3_options;

struct SizingField {
  using FT = Kernel::FT;
  using Point_3 = Point;
  using Index = SolidDomain::Index;

  const SizeField* field;
  MeshWatch* watch;
  double factor;

  FT operator()(const Point& p, int, const Index&) const {
    watch->question();
    return factor * size_at(*field, to_vector(p));
  }
};

struct LineSizingField {
  using FT = Kernel::FT;
  using Point_3 = Point;
  using Index = SolidDomain::Index;
  SizingField size;
  BallSize balls;
  bool clear_of_patches;

  FT operator()(const Point& p, int dimension, const Index& index) const {
    const double wanted = size(p, dimension, index);
    if (!clear_of_patches || dimension != 1) return wanted;
    return balls.at(to_vector(p), index - 1, wanted);
  }
};

void insert_points(const SurfaceMesh& surface, const Patches& patches, int shell,
                   Complex& complex) {
  for (const int t : spread_triangles(surface, patches.shell, shell)) {
    const Vector3d p =
        (corner(surface, t, 0) + corner(surface, t, 1) + corner(surface, t, 2)) / 3.0;
    const auto vertex = complex.triangulation().insert(Triangulation::Weighted_point(to_point(p)));
    if (vertex == Complex::Vertex_handle()) continue;  // hidden by a protecting ball
    complex.set_dimension(vertex, 2);
    complex.set_index(vertex, patches.of_triangle[static_cast<std::size_t>(t)] + 1);
  }
}

// Protecting balls on the feature lines. The refinement looks for surface where it has points
// already, so shells without lines (a round cavity) get some; with `seed_shells` all get some, as
// lines may lie in one plane and the shell far above it.
void start_complex(const SurfaceMesh& surface, const Patches& patches, const SolidDomain& domain,
                   const Criteria& criteria, const Control& control, bool seed_shells,
                   const MeshWatch& watch, Complex& complex) {
  MeshWatch::Alarm alarm(watch);
  CGAL::Mesh_3::internal::init_c3t3_with_features(
      complex, domain, criteria, control.nonlinear_growth_of_balls,
      control.maximal_number_of_vertices, control.pointer_to_error_code, alarm.flag());
  if (*alarm.flag()) throw MeshWatch::Stop{MeshWatch::Limit::time};
  std::vector<bool> has_line(static_cast<std::size_t>(patches.shells), false);
  for (std::size_t t = 0; t < patches.line.size(); ++t)
    for (const bool line : patches.line[t])
      if (line) has_line[static_cast<std::size_t>(patches.shell[t])] = true;
  for (int shell = 0; shell < patches.shells; ++shell)
    if (seed_shells || !has_line[static_cast<std::size_t>(shell)])
      insert_points(surface, patches, shell, complex);
  bool surface_found = false;
  if (complex.triangulation().dimension() == 3) {
    CGAL::Mesh_3::C3T3_helpers<Complex, SolidDomain>(complex, domain).update_restricted_facets();
    surface_found = complex.number_of_facets() > 0;
  }
  if (surface_found) return;
  for (int shell = 0; shell < patches.shells; ++shell)
    insert_points(surface, patches, shell, complex);
}

// The patch of a boundary side; the nearest one where the complex does not know it.
int label_of(const Complex& complex, Complex::Cell_handle cell, int k, const Patches& patches,
             const SolidOracle& oracle) {
  if (const int patch = cell->surface_patch_index(k); complex.is_in_complex(cell, k))
    return patch - 1;
  Vector3d center = Vector3d::Zero();
  for (const int i : kTetSides[k]) {
    const auto& p = cell->vertex(i)->point();
    center += Vector3d(p.x(), p.y(), p.z()) / 3.0;
  }
  return patches.of_triangle[static_cast<std::size_t>(oracle.nearest(center, -1).triangle)];
}

// Of all vertices, those of the protecting balls included.
std::vector<Vector3d> points_of(const Complex& complex) {
  std::vector<Vector3d> points;
  for (const auto vertex : complex.triangulation().finite_vertex_handles()) {
    const auto& p = vertex->point();
    points.emplace_back(p.x(), p.y(), p.z());
  }
  return points;
}

LinearTets extract(const Complex& complex, const Patches& patches, const SolidOracle& oracle) {
  LinearTets mesh;
  std::unordered_map<const void*, int> index;
  for (auto cell = complex.cells_in_complex_begin(); cell != complex.cells_in_complex_end();
       ++cell) {
    std::array<int, 4> tet, labels;
    for (int k = 0; k < 4; ++k) {
      const auto vertex = cell->vertex(k);
      const auto [at, fresh] = index.try_emplace(&*vertex, static_cast<int>(mesh.points.size()));
      if (fresh) {
        const auto& p = vertex->point();
        mesh.points.emplace_back(p.x(), p.y(), p.z());
        mesh.dimension.push_back(complex.in_dimension(vertex));
      }
      tet[static_cast<std::size_t>(k)] = at->second;
      labels[static_cast<std::size_t>(k)] = complex.is_in_complex(cell->neighbor(k))
                                                ? -1
                                                : label_of(complex, cell, k, patches, oracle);
    }
    mesh.tets.push_back(tet);
    mesh.side_label.push_back(labels);
  }
  return mesh;
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

LinearTets delaunay_mesh(const PreparedSurface& prepared, const SizeField& size,
                         const MeshOptions& options, Attempt attempt, MeshWatch& watch) {
  const auto& [surface, simplified, topology, patches, lines, oracle] = prepared;
  CGAL::get_default_random() = CGAL::Random(0);  // the same mesh in every run
  const SizingField length{&size, &watch, 1.0};
  const LineSizingField line_length{length, BallSize(prepared), attempt.clear_balls};
  const SizingField distance{&size, &watch, options.facet_distance};
  CGAL::Mesh_error_code error = CGAL::CGAL_MESH_3_NO_ERROR;
  namespace set = CGAL::parameters;
  Complex complex;
  try {
    const SolidDomain domain(surface, patches, lines, oracle, watch);
    const Criteria criteria(
        set::edge_size = line_length, set::facet_size = length,
        set::facet_angle = options.facet_angle / kDegree, set::facet_distance = distance,
        set::facet_topology = attempt.separate_patches ? CGAL::FACET_VERTICES_ON_SAME_SURFACE_PATCH
                                                       : CGAL::FACET_VERTICES_ON_SURFACE,
        set::cell_radius_edge_ratio = options.radius_edge, set::cell_size = length);
    watch.start_balls(size);
    Control control;
    control.maximal_number_of_vertices = options.max_vertices;
    control.pointer_to_error_code = &error;
    start_complex(surface, patches, domain, criteria, control, attempt.seed_shells, watch, complex);
    // Without exudation, perturbation, Odt, Lloyd and reset: what refine_mesh_3 calls, whose
    // named parameters do not take `control` from CGAL 6 on.
    CGAL::refine_mesh_3_impl(complex, domain, criteria, false, false, false, false, false, control);
    if (error == CGAL::CGAL_MESH_3_MAXIMAL_NUMBER_OF_VERTICES_REACHED)
      watch.report(MeshWatch::Limit::vertices, size, points_of(complex));
    if (complex.number_of_cells_in_complex() == 0) throw MeshBreakdown("the mesh is empty");
    return extract(complex, patches, oracle);
  } catch (const MeshWatch::Stop& stop) {
    watch.report(stop.limit, size, points_of(complex));
  } catch (const CGAL::Failure_exception& e) {
    throw MeshBreakdown(std::string("the mesher broke down: ") + first_line(e.message()));
  }
}

}  // namespace codesign::fem
