#include "fem/la/one_thread.hpp"

#include <mutex>

// Of OpenBLAS and OpenMP, where they are linked.
extern "C" {
int openblas_get_num_threads() __attribute__((weak));
void openblas_set_num_threads(int threads) __attribute__((weak));
int omp_get_max_active_levels() __attribute__((weak));
void omp_set_max_active_levels(int levels) __attribute__((weak));
}

namespace codesign::fem {
namespace {

std::mutex mutex;
int living = 0, blas_threads = 1;

int deactivate_omp() {
  if (!omp_get_max_active_levels || !omp_set_max_active_levels) return 0;
  const int levels = omp_get_max_active_levels();
  if (levels != 0) omp_set_max_active_levels(0);
  return levels;
}

}  // namespace

OneThread::OneThread() : omp_levels_(deactivate_omp()) {
  const std::lock_guard<std::mutex> lock(mutex);
  if (living++ > 0) return;
  if (openblas_get_num_threads && openblas_set_num_threads) {
    blas_threads = openblas_get_num_threads();
    if (blas_threads != 1) openblas_set_num_threads(1);
  }
}

OneThread::~OneThread() {
  if (omp_levels_ > 0) omp_set_max_active_levels(omp_levels_);
  const std::lock_guard<std::mutex> lock(mutex);
  if (--living == 0 && blas_threads > 1) openblas_set_num_threads(blas_threads);
}

}  // namespace codesign::fem
