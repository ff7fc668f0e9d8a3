#!/usr/bin/env bash
# The README's two commands on a new Debian 12, as root and as a user with sudo, on the committed tree.
#
#   tests/fresh/run.sh            both people, serve and test
#   tests/fresh/run.sh --quick    root, serve
#   tests/fresh/run.sh SUITE...   root, serve and the suites of these names
#
# Needs root.
set -euo pipefail

if ((EUID != 0)); then exec sudo "$0" "$@"; fi
# In namespaces of their own, mounts and processes cannot outlive this script.
if [[ -z ${FRESH_INSIDE-} ]]; then
  FRESH_INSIDE=1 exec unshare --mount --pid --fork --kill-child --mount-proc "$0" "$@"
fi

cd "$(dirname "$0")/../.."
work=$(mktemp -d /var/tmp/cyanometer-fresh.XXXXXX)
port=18$((RANDOM % 900 + 100))

clean_up() {
  local mount
  # The list is in the order of mounting, so that the inner ones leave first when read backwards.
  mapfile -t mounts < <(awk -v under="$work/" 'index($2, under) == 1 {print $2}' /proc/mounts | tac)
  for mount in "${mounts[@]}"; do umount --lazy "$mount" || true; done
  rm -rf --one-file-system "$work"
}
trap clean_up EXIT

say() { echo "fresh: $*"; }

# new_machine PERSON: a Debian with nothing but its base, and the committed tree in the person's home.
new_machine() {
  local machine=$work/$1 home
  say "a new machine for $1"
  mkdir "$machine"
  tar -xf "$work/base.tar" -C "$machine"
  cp /etc/resolv.conf /etc/hosts "$machine/etc/"
  mount -t proc proc "$machine/proc"
  mount --rbind /dev "$machine/dev"
  mount --make-rslave "$machine/dev"
  if [[ $1 != root ]]; then
    chroot "$machine" useradd --create-home "$1"
    chroot "$machine" apt-get -q update
    DEBIAN_FRONTEND=noninteractive chroot "$machine" apt-get -q -y --no-install-recommends \
      install sudo
    echo "$1 ALL=(ALL) NOPASSWD: ALL" >"$machine/etc/sudoers.d/$1"
  fi
  home=$machine$(home_of "$1")
  mkdir -p "$home/cyanometer"
  git -c safe.directory='*' archive HEAD | tar -x -C "$home/cyanometer"
  chroot "$machine" chown -R "$1:" "$(home_of "$1")/cyanometer"
}

home_of() { if [[ $1 == root ]]; then echo /root; else echo "/home/$1"; fi; }

# enter PERSON COMMAND...: becomes the person in the repository of the person's machine.
enter() {
  local person=$1 home
  home=$(home_of "$1")
  shift
  # shellcheck disable=SC2016
  exec chroot --userspec="$person:$person" "$work/$person" env -i HOME="$home" USER="$person" \
    PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 \
    bash -c 'cd "$HOME/cyanometer" && exec "$@"' - "$@"
}

# The daemon answers a render, and ends well when asked to.
try_serve() {
  local server picture=$work/sky.png status=0
  say "$1: ./cyanometer serve"
  (enter "$1" ./cyanometer serve --listen "127.0.0.1:$port") &
  server=$!
  until curl -sf -m 5 -o /dev/null "http://127.0.0.1:$port/readyz"; do
    if ! kill -0 "$server" 2>/dev/null; then
      say "$1: the daemon ended"
      return 1
    fi
    sleep 1
  done
  curl -sSf -m 120 -d '{}' -o "$picture" "http://127.0.0.1:$port/v1/render"
  if [[ $(head -c 8 "$picture" | od -An -tx1) != " 89 50 4e 47 0d 0a 1a 0a" ]]; then
    say "$1: the answer is no PNG"
    return 1
  fi
  kill -TERM "$server"
  wait "$server" || status=$?
  say "$1: a picture of $(stat -c %s "$picture") bytes; the daemon ended with $status"
  return "$status"
}

# A second start has nothing to set up.
try_start_again() {
  local begin=$EPOCHREALTIME
  (enter "$1" ./cyanometer serve --help) >/dev/null
  say "$1: started again in $((${EPOCHREALTIME/./} - ${begin/./})) us"
}

try_test() {
  local person=$1
  shift
  say "$person: ./cyanometer test $*"
  (enter "$person" ./cyanometer test "$@")
}

sources=/etc/apt/sources.list.d/debian.sources
if [[ ! -f $sources ]]; then
  echo "fresh: there is no $sources to install a new Debian from" >&2
  exit 1
fi
mmdebstrap --quiet --variant=minbase --mode=root bookworm "$work/base.tar" "$sources"

new_machine root
case ${1-} in
  --quick)
    try_serve root
    try_start_again root
    ;;
  ?*)
    try_serve root
    try_test root "$@"
    ;;
  *)
    try_test root
    try_serve root
    try_start_again root
    new_machine visitor
    try_serve visitor
    try_test visitor
    ;;
esac
say "the commands work on a new machine"
