#!/usr/bin/env bash
# Every row of the stability suite at its hardest, and random scenes; half an hour of two cores.
set -euo pipefail

./cyanometer build
ctest --test-dir build --verbose --no-tests=error -L '^stability$'
