#pragma once

namespace codesign::fem {

// Keeps BLAS and CHOLMOD on the calling thread while it lives: parallelism is between designs, and
// waiting threads of a busy machine cost more than they give (measured: twice the time).
// Of several at once the first one sets and the last one restores what belongs to the process.
class OneThread {
 public:
  OneThread();
  ~OneThread();
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  int omp_levels_;  // a setting of the calling thread
};

}  // namespace codesign::fem
