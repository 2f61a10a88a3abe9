#!/usr/bin/env bash
# What is committed, built and tested in a clean root of a Debian release. As root; needs debootstrap.
#   tests/distribution/in_root.sh bookworm|trixie [build]
# The root stays in build/root-RELEASE, so that a second run needs no packages; `build` alone tests nothing.
set -euo pipefail
suite=$1 task=${2:-test}
root=$PWD/build/root-$suite
mirror=${GLINT_DEBIAN_MIRROR:-http://deb.debian.org/debian}
registry=$(npm config get registry 2>/dev/null || true)
in_root() {
  chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
    ${http_proxy:+http_proxy="$http_proxy"} ${https_proxy:+https_proxy="$https_proxy"} ${registry:+npm_config_registry="$registry"} "$@"
}

if [ ! -e "$root/complete" ]; then
  rm -rf --one-file-system "$root"
  mkdir -p "$root"
  debootstrap --variant=minbase "$suite" "$root" "$mirror" >/dev/null
  # Apt as this machine has it set up (proxies); the release's own updates.
  cp -r /etc/apt/apt.conf.d "$root/etc/apt/" 2>/dev/null || true
  cp /etc/resolv.conf "$root/etc/" 2>/dev/null || true
  touch "$root/complete"
fi
mountpoint -q "$root/proc" || mount -t proc proc "$root/proc"
trap 'umount "$root/proc" 2>/dev/null || true' EXIT
mkdir -p "$root/srv/glint"
find "$root/srv/glint" -mindepth 1 -maxdepth 1 ! -name build -exec rm -rf {} +
git archive HEAD | tar -x -m -C "$root/srv/glint"  # newer than what was built before
if [ "$task" = build ]; then
  in_root bash -c 'cd /srv/glint && ./dev build'
else
  in_root bash -c 'cd /srv/glint && ./dev test && ./dev package'
fi
in_root bash -c '. /etc/os-release; echo "$PRETTY_NAME: built$([ '"$task"' = build ] || echo ", tested, packaged")"'
