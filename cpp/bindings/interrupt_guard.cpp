#include "bindings/interrupt_guard.hpp"

#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>
#include <string_view>
#include <system_error>
#include <thread>

namespace codesign {

namespace {

using Clock = std::chrono::steady_clock;

// Never destroyed: the guard's thread may outlive the statics of the module.
struct State {
  std::mutex mutex;
  std::condition_variable changed;
  Clock::time_point acknowledged{};
  std::set<std::filesystem::path> temporaries;
};

State& state() {
  static State* const one = new State;
  return *one;
}

void say(std::string_view text) {
  if (write(STDERR_FILENO, text.data(), text.size()) < 0) return;  // nobody listens
}

[[noreturn]] void end_process() {
  for (const std::filesystem::path& path : state().temporaries) {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  if (isatty(STDERR_FILENO)) say("\x1b[?25h\n");  // a progress bar hides the cursor
  say("interrupted\n");
  _exit(128 + SIGINT);
}

// Python may take note before the thread of the guard reads the number, and takes note only once of
// two interrupts in a row: what it did up to `grace` before the reading counts.
void watch(int descriptor, Clock::duration grace) {
  sigset_t all;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, nullptr);  // signals are for Python's main thread
  unsigned char number = 0;
  while (read(descriptor, &number, 1) == 1 && number != 0) {
    if (number != SIGINT) continue;
    const Clock::time_point now = Clock::now();
    std::unique_lock lock(state().mutex);
    const bool seen = state().changed.wait_until(
        lock, now + grace, [&] { return state().acknowledged > now - grace; });
    if (!seen) end_process();
  }
  close(descriptor);
}

}  // namespace

void start_interrupt_guard(int descriptor, double grace) {
  const std::chrono::duration<double> seconds(grace);
  std::thread(watch, descriptor, std::chrono::duration_cast<Clock::duration>(seconds)).detach();
}

void acknowledge_interrupts() {
  const std::lock_guard lock(state().mutex);
  state().acknowledged = Clock::now();
  state().changed.notify_all();
}

void add_temporary(const std::filesystem::path& path) {
  const std::lock_guard lock(state().mutex);
  state().temporaries.insert(path);
}

void remove_temporary(const std::filesystem::path& path) {
  const std::lock_guard lock(state().mutex);
  state().temporaries.erase(path);
}

}  // namespace codesign
