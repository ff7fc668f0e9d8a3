#!/usr/bin/env bash
# Every row of the stability suite at its hardest, and random scenes; a quarter of an hour of two cores.
set -euo pipefail

./cyanometer build
ctest --test-dir build --verbose --no-tests=error -L '^stability$'
