#pragma once

#include <string>
#include <string_view>

namespace codesign::fem {

// What a file holds that is no STL, with the remedy, as "a STEP file: export ...", from its first
// bytes; empty if they tell nothing.
std::string foreign_format(std::string_view bytes);

}  // namespace codesign::fem
