#!/bin/sh
# Reads damaged STL files under the address, leak and undefined-behavior sanitizers.
# Usage: benchmarks/robustness/fuzz_stl.sh [FILES, default 1000000]
set -eu
cd "$(dirname "$0")/../.."
cmake --preset asan > /dev/null
cmake --build --preset asan --target fem_test_stl
export CODESIGN_FUZZ_RUNS="${1:-1000000}"
export ASAN_OPTIONS=detect_leaks=1:strict_string_checks=1 UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
exec build/asan/tests/cpp/fem_test_stl --gtest_filter=Stl.SurvivesDamagedFiles
