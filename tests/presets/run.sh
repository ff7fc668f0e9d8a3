#!/usr/bin/env bash
# Every preset through every method; some twenty minutes of two cores, most of them for the kernels of each.
set -euo pipefail

./cyanometer build
tests/on_all_cores build/test_presets --gtest_brief=1
