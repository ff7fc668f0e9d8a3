#!/usr/bin/env bash
# The compiled suites once more, built with AddressSanitizer (leaks too) and UBSan. No suppressions: the
# software driver is clean, and one for it would hide our own leaks.
set -euo pipefail

./cyanometer build
options=(-DCMAKE_BUILD_TYPE=Debug -DCYANOMETER_SANITIZE='address,undefined')
if command -v ccache >/dev/null; then options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
cmake -G Ninja -B build-asan "${options[@]}"
ninja -C build-asan
export ASAN_OPTIONS=detect_leaks=1:detect_stack_use_after_return=1:check_initialization_order=1
export UBSAN_OPTIONS=print_stacktrace=1
ctest --test-dir build-asan --output-on-failure --no-tests=error -LE '^further$'
