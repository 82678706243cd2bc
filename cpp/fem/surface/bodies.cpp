#include "fem/surface/bodies.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "errors.hpp"

namespace codesign::fem {
namespace {

constexpr std::size_t kMostNamed = 4;  // bodies in a message

struct Shell {
  double volume = 0.0;  // m³, negative if it bounds a cavity
  Eigen::AlignedBox3d box;
};

std::vector<Shell> shells(const SurfaceMesh& surface, const Patches& patches) {
  const Eigen::Vector3d origin = surface.points.colwise().mean().transpose();
  std::vector<Shell> found(static_cast<std::size_t>(patches.shells));
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t) {
    Shell& shell = found[static_cast<std::size_t>(patches.shell[static_cast<std::size_t>(t)])];
    const Eigen::Vector3d a = corner(surface, t, 0), b = corner(surface, t, 1),
                          c = corner(surface, t, 2);
    shell.volume += (a - origin).dot((b - origin).cross(c - origin)) / 6.0;
    shell.box.extend(a).extend(b).extend(c);
  }
  return found;
}

std::string text(const char* format, double value) {
  char digits[32];
  std::snprintf(digits, sizeof digits, format, value);
  return digits;
}

std::string place(const Shell& shell) {
  const Eigen::Vector3d p = shell.box.center();
  return "(" + text("%.4g", p.x()) + ", " + text("%.4g", p.y()) + ", " + text("%.4g", p.z()) + ")";
}

// "a, b and c", or the first few of many.
std::string listed(const std::vector<std::string>& items) {
  std::string list;
  for (std::size_t i = 0; i < std::min(items.size(), kMostNamed); ++i) {
    if (i > 0) list += i + 1 == items.size() ? " and " : ", ";
    list += items[i];
  }
  return items.size() > kMostNamed ? list + ", ..." : list;
}

}  // namespace

void check_one_body(const SurfaceMesh& surface, const Patches& patches) {
  if (patches.shells == 1) return;
  std::vector<Shell> bodies, cavities;
  for (const Shell& shell : shells(surface, patches))
    (shell.volume > 0.0 ? bodies : cavities).push_back(shell);
  for (const Shell& cavity : cavities)
    if (std::none_of(bodies.begin(), bodies.end(),
                     [&](const Shell& body) { return body.box.contains(cavity.box); }))
      throw MeshError("the shell around " + place(cavity) + " m is inside-out: it encloses " +
                      text("%.4g", cavity.volume * 1e9) +
                      " mm³ and lies in no other; swap two corners of each of its triangles");
  if (bodies.size() == 1) return;
  std::sort(bodies.begin(), bodies.end(),
            [](const Shell& a, const Shell& b) { return a.volume > b.volume; });
  std::vector<std::string> volumes, places;
  for (const Shell& body : bodies) {
    volumes.push_back(text("%.4g", body.volume * 1e9));
    places.push_back(place(body));
  }
  throw MeshError(
      "the surface bounds " + std::to_string(bodies.size()) + " bodies of " + listed(volumes) +
      " mm³ around " + listed(places) +
      " m, one is needed: give each its own file, or unite those that overlap or touch");
}

}  // namespace codesign::fem
