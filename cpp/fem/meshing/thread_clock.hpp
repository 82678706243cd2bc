#pragma once

#include <time.h>

namespace codesign::fem {

// Processor time of the calling thread. [s]
inline double thread_seconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace codesign::fem
