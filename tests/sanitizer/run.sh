#!/usr/bin/env bash
# The compiled suites once more, built with AddressSanitizer (leaks too) and UBSan. No suppressions: one
# for the software driver would hide our own leaks (keep_libraries.cpp says what takes its place).
set -euo pipefail

./cyanometer build
options=(-DCMAKE_BUILD_TYPE=Debug -DCYANOMETER_SANITIZE='address,undefined')
if command -v ccache >/dev/null; then options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
cmake -G Ninja -B build-asan "${options[@]}"
ninja -C build-asan everything
export ASAN_OPTIONS=detect_leaks=1:detect_stack_use_after_return=1:check_initialization_order=1
export UBSAN_OPTIONS=print_stacktrace=1
# First that a leak which is there on purpose is found.
ctest --test-dir build-asan --output-on-failure --no-tests=error -L '^sanitizer$'
# Random scenes and those that break methods go the ways of the other suites' for hours.
ctest --test-dir build-asan --output-on-failure --no-tests=error -LE '^(further|stability)$'
