#pragma once

#include <filesystem>

// What ends a process that Ctrl-C cannot reach: a thread outside Python. Signal handlers of Python
// run on its main thread between two instructions, so a library call that takes long and asks
// nobody (a factorization, a boolean operation of solids) keeps them waiting.
namespace codesign {

// Watches a descriptor to which Python writes the number of each signal (signal.set_wakeup_fd). An
// interrupt that is not acknowledged within `grace` seconds ends the process: temporary files are
// removed, the exit code is 130. A zero byte, or the end of the stream, ends the watch.
void start_interrupt_guard(int descriptor, double grace);

// Python has taken note of the interrupts so far.
void acknowledge_interrupts();

// A file or folder to be removed if the guard ends the process.
void add_temporary(const std::filesystem::path& path);
void remove_temporary(const std::filesystem::path& path);

}  // namespace codesign
