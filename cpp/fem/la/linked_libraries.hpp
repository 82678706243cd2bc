#pragma once

#include <map>
#include <string>

namespace codesign::fem {

// Versions of the shared libraries that decide digits, as loaded in this process (not as compiled
// against): CHOLMOD, OpenBLAS with the kernel that it chose for this processor, the C library with
// its mathematical functions.
std::map<std::string, std::string> linked_libraries();

}  // namespace codesign::fem
