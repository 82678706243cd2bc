#include "fem/surface_mesh.hpp"
