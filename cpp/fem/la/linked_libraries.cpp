#include "fem/la/linked_libraries.hpp"

#include <cholmod.h>
#include <gnu/libc-version.h>

#include <array>
#include <sstream>

// Of OpenBLAS, where it is linked.
extern "C" {
char* openblas_get_config() __attribute__((weak));
char* openblas_get_corename() __attribute__((weak));
}

namespace codesign::fem {

namespace {

std::string cholmod_text() {
  std::array<int, 3> version{};
  cholmod_version(version.data());
  return std::to_string(version[0]) + '.' + std::to_string(version[1]) + '.' +
         std::to_string(version[2]);
}

// "OpenBLAS 0.3.21 NO_LAPACKE DYNAMIC_ARCH … MAX_THREADS=64": the version is the second word.
std::string blas_text() {
  if (!openblas_get_config || !openblas_get_corename) return "another BLAS";
  std::istringstream words(openblas_get_config());
  std::string name;
  std::string version;
  words >> name >> version;
  return version + ' ' + openblas_get_corename();
}

}  // namespace

std::map<std::string, std::string> linked_libraries() {
  return {{"CHOLMOD", cholmod_text()},
          {"OpenBLAS", blas_text()},
          {"C library", gnu_get_libc_version()}};
}

}  // namespace codesign::fem
