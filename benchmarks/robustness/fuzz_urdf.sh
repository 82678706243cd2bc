#!/bin/sh
# Loads mutated URDFs under the address, leak and undefined-behavior sanitizers.
# Usage: benchmarks/robustness/fuzz_urdf.sh [RUNS, default 100000] [FOLDER of further URDF files to mutate]
set -eu
cd "$(dirname "$0")/../.."
cmake --preset asan > /dev/null
cmake --build --preset asan --target dynamics_test_urdf_fuzz
export CODESIGN_FUZZ_RUNS="${1:-100000}"
if [ $# -gt 1 ]; then export CODESIGN_FUZZ_SEEDS="$2"; fi
export ASAN_OPTIONS=detect_leaks=1:strict_string_checks=1 UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
exec build/asan/tests/cpp/dynamics_test_urdf_fuzz
