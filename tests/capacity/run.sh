#!/usr/bin/env bash
# What a start and a frame cost on this machine, against what docker/README.md says under "Capacity": fails
# where a frame costs over 15 % more or less. Some three minutes; alone, for who shares the processor's
# caches makes frames dearer.
#
#   tests/capacity/run.sh            measures and compares
#   tests/capacity/run.sh --print    only prints what the guide would say of this machine
set -euo pipefail
cd "$(dirname "$0")/../.."

if [[ ${1-} != --print ]]; then node --test --test-reporter=tap tests/capacity/guide.test.mjs; fi
if [[ -z ${CYANOMETER_BINARY-} ]]; then ./cyanometer devices >/dev/null; fi
exec node tests/capacity/measure.mjs "$@"
