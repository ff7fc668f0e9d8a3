#!/usr/bin/env bash
# The image, built from the Dockerfile as it is on a new Debian, and run as a cluster would: as nobody
# in particular, with nothing to write to but its cache. No docker engine is needed.
#
#   tests/container/run.sh           builds the image and tries it
#   tests/container/run.sh --keep    leaves the image for the next run, which builds faster
#
# Needs root.
set -euo pipefail

if ((EUID != 0)); then exec sudo "$0" "$@"; fi
cd "$(dirname "$0")/../.."

image=localhost/cyanometer
name=cyanometer-test-$$
port=18$((RANDOM % 900 + 100))
origin=http://127.0.0.1:$port
storage=/var/tmp/cyanometer-container
mkdir -p "$storage/out"
cat >"$storage/storage.conf" <<EOF
[storage]
driver = "overlay"
runroot = "$storage/run"
graphroot = "$storage/graph"
EOF
export CONTAINERS_STORAGE_CONF=$storage/storage.conf

keep=${1-}
clean_up() {
  podman rm -f -t 0 "$name" >/dev/null 2>&1 || true
  if [[ $keep != --keep ]]; then
    podman rmi -a -f >/dev/null 2>&1 || true
    rm -rf --one-file-system "$storage"
  fi
}
trap clean_up EXIT

say() { echo "container: $*"; }
fail() {
  say "FAILED: $*"
  podman logs "$name" 2>&1 | tail -n 5 || true
  exit 1
}
# expect WHAT COMMAND...: the command succeeds.
expect() {
  local what=$1
  shift
  "$@" || fail "$what"
  say "ok: $what"
}
refuse() { ! "$@" 2>/dev/null; }

# A Debian without manual pages and translations, as the slim one is.
make_base() {
  local excluded=(man info locale lintian)
  if podman image exists docker.io/library/debian:bookworm-slim; then return; fi
  mmdebstrap --quiet --variant=minbase --mode=root "${excluded[@]/#/--dpkgopt=path-exclude=/usr/share/}" \
    bookworm "$storage/base.tar" /etc/apt/sources.list.d/debian.sources
  podman import -q "$storage/base.tar" docker.io/library/debian:bookworm-slim >/dev/null
  rm "$storage/base.tar"
}

build_image() {
  local begin=$SECONDS
  buildah bud --isolation=chroot --format docker --pull-never --layers -q \
    -f docker/Dockerfile -t "$image" . >"$storage/build.log" 2>&1 ||
    { tail -n 40 "$storage/build.log" && fail "the image is built"; }
  say "built in $((SECONDS - begin)) s"
}

# As Kubernetes runs it under the restricted profile. The health is asked for from here: by itself it
# would want systemd.
hardened=(--network=host --ulimit nofile=1024:1024 --ulimit nproc=4096:4096 --health-interval=disable
  --read-only --read-only-tmpfs=false --cap-drop=all --security-opt no-new-privileges)
run() { podman --log-level=fatal --cgroup-manager=cgroupfs --runtime runc run "${hardened[@]}" "$@"; }

# start OPTION...: the daemon, in the background.
start() {
  podman rm -f -t 0 "$name" >/dev/null 2>&1 || true
  run -d --name "$name" -e CYANOMETER_LISTEN="127.0.0.1:$port" "$@" "$image" >/dev/null
}
healthy() {
  local end=$((SECONDS + 300))
  while ((SECONDS < end)); do
    if podman healthcheck run "$name" >/dev/null 2>&1; then return; fi
    if [[ $(state .State.Running) != true ]]; then return 1; fi
    sleep 0.1
  done
  return 1
}
state() { podman inspect --format "{{$1}}" "$name"; }
config() { podman image inspect --format "{{$1}}" "$image"; }
# Seconds of CPU that the daemon has used so far.
cpu_s() { awk '{print ($14 + $15) / 100}' "/proc/$(state .State.Pid)/stat"; }
render() { curl -sS -m 300 -o "$storage/out/$1" -w '%{http_code}' -d "$2" "$origin/v1/render"; }
is_png() { [[ $(head -c 4 "$1" | tail -c 3) == PNG ]]; }

# Of the files of that name under a folder, MB.
size_of() { find "$1" -type f -name "$2" -printf '%s\n' | awk '{sum += $1} END {printf "%.0f", sum / 1e6}'; }

check_image() {
  local mb root
  mb=$(($(config .Size) / 1000000))
  root=$(podman image mount "$image")
  say "the image has $mb MB, of which LLVM is $(size_of "$root" 'libLLVM*')"
  expect "at most 300 MB" test "$mb" -le 300
  expect "its user is not root" test "$(config .User)" == 10001:10001
  expect "no shell" refuse run --rm --entrypoint /bin/sh "$image" -c true
  expect "the licences are there" test -s "$root/usr/share/doc/libllvm15/copyright"
  expect "nothing is setuid" test -z "$(find "$root" -perm /6000 -print -quit)"
  podman image umount "$image" >/dev/null
  run --rm "$image" devices | tee "$storage/out/devices"
  expect "lavapipe would be used" grep -q '^\* *llvmpipe' "$storage/out/devices"
}

check_daemon() {
  local begin=$EPOCHREALTIME uid
  start
  expect "healthy, says HEALTHCHECK" healthy
  warm_s=$(cpu_s)
  say "after $(((${EPOCHREALTIME/./} - ${begin/./}) / 1000)) ms, $warm_s s of CPU"
  uid=$(awk '/^Uid:/ {print $2}' "/proc/$(state .State.Pid)/status")
  expect "it runs as 10001" test "$uid" == 10001
  expect "it renders" test "$(render sky.png '{}')" == 200
  expect "a PNG" is_png "$storage/out/sky.png"
  expect "the metrics are on the other port" curl -sSf -o /dev/null http://127.0.0.1:9090/metrics
}

check_stop() {
  local slow='{"method":{"name":"nishita","view_samples":300,"light_samples":300},"image":{"width":64,"height":36}}'
  render stopped.png "$slow" >"$storage/out/status" &
  sleep 0.5
  podman --log-level=fatal stop -t 120 "$name" >/dev/null
  wait $!
  expect "what was in flight is answered" test "$(<"$storage/out/status")" == 200
  expect "SIGTERM ends it with 0" test "$(state .State.ExitCode)" == 0
}

check_wrong_port() {
  start -e CYANOMETER_OPS_LISTEN=127.0.0.1:0
  until curl -sf -o /dev/null "$origin/readyz"; do sleep 0.2; done
  expect "HEALTHCHECK fails where nobody listens" refuse podman healthcheck run "$name"
}

# What the image's cache is worth; on another kind of processor it counts for nothing.
check_cache() {
  local cold_s
  start -e XDG_CACHE_HOME=/nowhere
  expect "it starts without what was compiled" healthy
  cold_s=$(cpu_s)
  say "$cold_s s of CPU without what was compiled"
  expect "a third of that at most with it" awk "BEGIN {exit !($warm_s * 3 < $cold_s)}"
}

check_memory() {
  local i statuses
  start --memory 1g --memory-swap 1g -e CYANOMETER_FRAME_MEMORY_MB=256 -e CYANOMETER_CACHE_MB=128
  expect "healthy in 1 GiB" healthy
  statuses=$(for i in {1..16}; do
    render "memory-$i.png" "{\"image\":{\"width\":1920,\"height\":1080,\"exposure_ev\":0.$i}}" &
  done; wait)
  expect "16 frames of 1080p at once in 1 GiB" test "$statuses" == "$(printf '200%.0s' {1..16})"
  expect "it was not killed" test "$(state .State.Running)/$(state .State.OOMKilled)" == true/false
}

check_commands() {
  local scene='{"image":{"width":32,"height":18}}'
  expect "the root cannot be written" refuse run --rm -i "$image" render - -o /tmp/sky.png <<<"$scene"
  rm -rf "$storage/out/frames"
  mkdir -m 777 "$storage/out/frames"
  echo '{"frames": 4, "to": {"sun.elevation_deg": 5}}' >"$storage/out/frames/sequence.json"
  expect "an Indexed Job's pod renders its frame" run --rm -i -v "$storage/out/frames:/frames" \
    -e JOB_COMPLETION_INDEX=2 "$image" render - --frames /frames/sequence.json --shard /4 \
    -o /frames/sky-%d.png <<<"$scene"
  expect "that one alone" test "$(cd "$storage/out/frames" && echo *.png)" == sky-2.png
}

make_base
build_image
say "built by buildah with chroot isolation; run by podman with runc"
check_image
check_daemon
check_stop
check_wrong_port
check_commands
check_memory
check_cache
say "the image does what it should"
