#!/usr/bin/env bash
# The two references against each other; some minutes of one core.
set -euo pipefail

./cyanometer build
ctest --test-dir build --verbose --no-tests=error -L '^references$'
