#pragma once

#include "errors.hpp"

namespace codesign {

// Supports or loads that make no sense for a part: they select nothing, act on held faces only,
// have no effect. A ValueError in Python too.
struct ModelError : Error {
  using Error::Error;
};

}  // namespace codesign
