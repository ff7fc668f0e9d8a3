#!/usr/bin/env bash
# Benchmarks: how long the engine's passes, methods, tables and encoders take, and whole requests. Arguments
# are Google Benchmark's, as --benchmark_filter=Encode. Nothing is asserted: times are told, and as ratios to a
# pass that only stores pixels.
set -euo pipefail

root=$(cd "$(dirname "$0")/../.." && pwd)
build=$root/build
cmake -S "$root" -B "$build" -DCYANOMETER_TESTS=ON >/dev/null # which looks whether the library is there now
ninja -C "$build" --quiet benchmarks
exec "$build/benchmarks" --benchmark_counters_tabular=true ${BENCHMARKS:-} "$@"
