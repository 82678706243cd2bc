#include <cstdio>

#include "dynamics/urdf/urdf.hpp"
#include "fem/surface/mass_properties.hpp"

// Prints the mass of a one-link robot and the volume of a tetrahedron with three unit edges: 2 and
// 1/6.
int main() {
  const codesign::dynamics::Model model = codesign::dynamics::load_urdf(
      "<robot name='ball'><link name='ball'><inertial><mass value='2'/>"
      "<inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link></robot>");
  codesign::fem::SurfaceMesh surface;
  surface.points.resize(4, 3);
  surface.points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  surface.triangles.resize(4, 3);
  surface.triangles << 0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3;
  surface.face.assign(4, 0);
  surface.face_names = {""};
  const double volume = codesign::fem::mass_properties(surface, 1.0).volume;
  std::printf("%g %g\n", model.total_mass, volume);
}
