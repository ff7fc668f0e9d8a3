#!/usr/bin/env bash
# The manifests in docker/k8s against the API's types, against each other and against the program; the
# dashboard's queries by a real Prometheus that scrapes a real daemon. Wants kubectl 1.27 or newer, for
# its kustomize, from kubernetes.io: Debian 12 has an older one.
set -euo pipefail
cd "$(dirname "$0")"

if ! kubectl kustomize ../../docker/k8s/gpu >/dev/null; then
  echo "kubernetes: there is no kubectl that makes docker/k8s/gpu" >&2
  exit 1
fi
if [[ -z ${CYANOMETER_BINARY-} ]]; then ../../cyanometer devices >/dev/null; fi
if [[ ! -d node_modules ]]; then npm ci --no-audit --no-fund >&2; fi
exec node --test --test-concurrency=1 --test-reporter=tap manifests.test.mjs metrics.test.mjs
