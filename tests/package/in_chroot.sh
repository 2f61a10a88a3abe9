#!/usr/bin/env bash
# The Debian packages in a clean Debian 12: installed, glint demo and Python's examples run, purged.
# As root; needs debootstrap.
#   tests/package/in_chroot.sh build/glint_*.deb build/python3-glint_*.deb FOLDER     (FOLDER is made anew and removed)
set -euo pipefail
deb=$(realpath "$1") python_deb=$(realpath "$2") root=$3
mirror=${GLINT_DEBIAN_MIRROR:-http://deb.debian.org/debian}
in_root() { chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive ${http_proxy:+http_proxy=$http_proxy} "$@"; }
clean_up() { umount "$root/proc" 2>/dev/null || true; rm -rf --one-file-system "$root"; }

[ -e "$root" ] && { echo "$root: exists; name a folder that does not" >&2; exit 2; }
trap clean_up EXIT
debootstrap --variant=minbase bookworm "$root" "$mirror" >/dev/null
mount -t proc proc "$root/proc"
# Apt as this machine has it set up (mirrors, proxies).
cp -r /etc/apt/sources.list* /etc/apt/apt.conf.d "$root/etc/apt/" 2>/dev/null || true
cp /etc/resolv.conf "$root/etc/" 2>/dev/null || true
cp "$deb" "$root/tmp/glint.deb"
cp "$python_deb" "$root/tmp/python3-glint.deb"
in_root apt-get update -qq
before=$(in_root dpkg-query -W -f '${Installed-Size}\n' | awk '{s += $1} END {print s}')

SECONDS=0
in_root apt-get install -y -qq --no-install-recommends /tmp/glint.deb >/dev/null 2>&1
installed_s=$SECONDS
after=$(in_root dpkg-query -W -f '${Installed-Size}\n' | awk '{s += $1} END {print s}')
SECONDS=0
in_root glint demo /srv/leather
demo_s=$SECONDS
work=$root/srv/leather/glint
[ -s "$work/report/index.html" ] && ls "$work"/export/*.glb >/dev/null
in_root apt-get install -y -qq --no-install-recommends /tmp/python3-glint.deb >/dev/null 2>&1
examples=/usr/share/doc/python3-glint/examples
in_root python3 $examples/load_and_plot.py /srv/leather /srv/sheet.png
in_root python3 $examples/relight.py /srv/leather /srv/frames --frames 3
in_root python3 $examples/fit_arrays.py --size 64 --photographs 5
in_root apt-get purge -y -qq python3-glint glint >/dev/null 2>&1
left=$(find "$root/usr" "$root/etc" "$root/var/lib" -path "$root/var/lib/apt" -prune -o -path "$root/var/lib/dpkg" -prune -o \( -name 'glint*' -o -name '_glint*' \) -print)
[ -z "$left" ] || { echo "left behind: $left" >&2; exit 1; }
echo "package $(du -h "$deb" | cut -f1); installed with its dependencies $(((after - before) / 1024)) MiB in $installed_s s, downloads included; glint demo $demo_s s; nothing left after the purge"
