#!/usr/bin/env bash
# docker/compose.yaml for what can be seen of it without containers; then three daemons as it sets them up,
# behind a real nginx with docker/nginx.conf as it is: who gets which request, what dies unnoticed, what is
# turned away. Some minutes.
#
# Needs root: the names and ports are those of the containers, in a network of its own.
set -euo pipefail
cd "$(dirname "$0")/../.."

if [[ -z ${REPLICAS_INSIDE-} ]]; then
  if [[ -z ${CYANOMETER_BINARY-} ]]; then ./cyanometer devices >/dev/null; fi
  as_root=()
  if ((EUID != 0)); then as_root=(sudo --preserve-env=CYANOMETER_BINARY); fi
  exec "${as_root[@]}" env REPLICAS_INSIDE=1 \
    unshare --mount --net --pid --fork --kill-child --mount-proc tests/replicas/run.sh "$@"
fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
ip link set lo up
docker-compose -f docker/compose.yaml config |
  python3 -c 'import json, sys, yaml; json.dump(yaml.safe_load(sys.stdin)["services"], sys.stdout)' \
    >"$work/services.json"
{
  echo '127.0.0.1 localhost'
  grep -o '"replica-[0-9]*"' "$work/services.json" | tr -d '"' | sort -u |
    awk '{print "127.0.0." NR + 1, $0}'
} >"$work/hosts"
mount --bind "$work/hosts" /etc/hosts
WORK=$work node --test --test-concurrency=1 --test-reporter=tap "$@" \
  tests/replicas/compose.test.mjs tests/replicas/replicas.test.mjs
