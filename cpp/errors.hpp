#pragma once

#include <stdexcept>
#include <string>

// Typed errors of the C++ core. Each is translated one-to-one to the class of the same name in
// codesign.errors. A wrong argument (size, sign, unknown name) is std::invalid_argument; an
// impossible input or a numerical breakdown is one of these; an expected outcome (flight lost,
// iteration limit) is a status in the result.
namespace codesign {

// Base of all.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A robot description that cannot be simulated; the message names the element.
struct UrdfError : Error {
  using Error::Error;
};

// A joint or frame that the robot does not have; a ValueError in Python too.
struct UnknownNameError : UrdfError {
  using UrdfError::UrdfError;
};

// A surface or volume mesh that is open, inverted, degenerate, too large, or could not be made.
struct MeshError : Error {
  using Error::Error;
};

// A limit of the mesher (work, vertices, time) was reached; the message names limit and place.
struct MeshLimitError : MeshError {
  using MeshError::MeshError;
};

// A linear system that is singular or whose solution misses the residual tolerance.
struct SolverError : Error {
  using Error::Error;
};

// An analysis that needs more memory than it may take; the message names both and the remedy.
struct MemoryLimitError : SolverError {
  using SolverError::SolverError;
};

}  // namespace codesign
