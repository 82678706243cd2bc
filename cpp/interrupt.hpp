#pragma once

#include <atomic>
#include <chrono>
#include <exception>

namespace codesign {

// A long computation was asked to stop (Ctrl-C). Not an Error: nothing is wrong with the input, so
// nobody who handles errors may swallow it.
struct Interrupted : std::exception {
  const char* what() const noexcept override { return "interrupted"; }
};

// Answers whether the computation of the calling thread shall stop. The library knows no signals
// and no Python: whoever runs it (the bindings, a test) says how that is found out.
using InterruptQuery = bool (*)();
inline std::atomic<InterruptQuery> interrupt_query{nullptr};

inline constexpr std::chrono::milliseconds kInterruptPeriod{50};

// Called by every loop that may take long, as often as it likes: one reading of the clock; the
// query is asked once in kInterruptPeriod. Throws Interrupted.
inline void check_interrupt() {
  using Clock = std::chrono::steady_clock;
  thread_local Clock::time_point last{};
  const InterruptQuery query = interrupt_query.load(std::memory_order_relaxed);
  if (query == nullptr) return;
  const Clock::time_point now = Clock::now();
  if (now - last < kInterruptPeriod) return;
  last = now;
  if (query()) throw Interrupted();
}

}  // namespace codesign
