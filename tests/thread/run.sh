#!/usr/bin/env bash
# The API's suite once more, built with ThreadSanitizer. Suppressed is what lies inside the software driver,
# which is not built with it; what is called from there is not.
#
#   tests/thread/run.sh [FILTER]      only these of the suite's tests, as GoogleTest filters them
set -euo pipefail

./cyanometer build
options=(-DCMAKE_BUILD_TYPE=Debug -DCYANOMETER_SANITIZE=thread)
if command -v ccache >/dev/null; then options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
cmake -G Ninja -B build-tsan "${options[@]}"
ninja -C build-tsan test_thread test_api cyanometer
export TSAN_OPTIONS="suppressions=$PWD/tests/thread/suppressions halt_on_error=1"
# First that a race which is there on purpose is found.
build-tsan/test_thread --gtest_brief=1
build-tsan/test_api --gtest_brief=1 --gtest_filter="${1-*}"
