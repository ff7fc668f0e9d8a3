#!/usr/bin/env bash
# The page's tests in a real Chromium, against the built daemon (or $CYANOMETER_BINARY); the pictures
# they take are in build/web-screenshots. CYANOMETER_WEB_TESTS names some of the files, else all are run.
set -euo pipefail
cd "$(dirname "$0")"
if [[ -z ${CYANOMETER_BINARY-} && -x ../../cyanometer ]]; then ../../cyanometer devices >/dev/null; fi
if [[ ! -d node_modules ]]; then npm ci --no-audit --no-fund >&2; fi
# shellcheck disable=SC2086  # names, of which each is a word
exec node --test --test-concurrency=1 --test-reporter=tap ${CYANOMETER_WEB_TESTS:-*.test.js}
