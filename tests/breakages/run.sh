#!/usr/bin/env bash
# Takes the page's features out one by one and demands that the page's tests notice: see breakages.js.
# The better part of an hour on two cores. CYANOMETER_BREAKAGES, a regular expression, names some of them:
#
#   CYANOMETER_BREAKAGES='undo|desktop.*probe' ./cyanometer test breakages
set -euo pipefail
cd "$(dirname "$0")"
if [[ -z ${CYANOMETER_BINARY-} && -x ../../cyanometer ]]; then ../../cyanometer devices >/dev/null; fi
if [[ ! -d ../web/node_modules ]]; then npm ci --prefix ../web --no-audit --no-fund >&2; fi
exec node --test --test-reporter=tap --test-name-pattern "${CYANOMETER_BREAKAGES-.}" breakages.test.js
