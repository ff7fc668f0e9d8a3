#!/usr/bin/env bash
# Every preset through every method; some three quarters of an hour of two cores, most of it for the kernels of each.
set -euo pipefail

./cyanometer build
tests/on_all_cores build/test_presets --gtest_brief=1
