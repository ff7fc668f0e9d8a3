#!/usr/bin/env bash
# The compiled suites once more under Vulkan's validation layer and its synchronization checks. The layer
# only prints: its marks are looked for in what the suites wrote.
set -euo pipefail

./cyanometer build
export CYANOMETER_VALIDATION=1
log=build/Testing/Temporary/LastTest.log

# The layer's marks in what the last suites wrote.
objections() { grep -E 'VUID-|SYNC-HAZARD-|UNASSIGNED-' "$log"; }

# First that a call which is wrong on purpose does leave its mark.
ctest --test-dir build --output-on-failure --no-tests=error -L '^validation$'
if ! objections >/dev/null; then
  echo "the validation layer's objections do not reach $log"
  exit 1
fi

# Random scenes and those that break methods go the ways of the other suites' for hours.
ctest --test-dir build --output-on-failure --no-tests=error -LE '^(further|stability)$'
if objections; then
  echo "the validation layer objects"
  exit 1
fi
echo "the validation layer has no objection"
