#!/usr/bin/env bash
# Every row of the stability suite at its hardest, and random scenes; a quarter of an hour of two cores.
set -euo pipefail

./cyanometer build

# What has a thread a core itself comes last.
threaded='RandomScenes.*'
failed=0
tests/on_all_cores build/test_stability --gtest_brief=1 --gtest_filter="-$threaded" || failed=1
build/test_stability --gtest_brief=1 --gtest_filter="$threaded" || failed=1
exit "$failed"
