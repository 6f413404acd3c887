#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Unpacks drm-shim, Vulkan drivers and moderngl for the Mesa of CHROOT (tests/gui/build_chroot.sh) into FOLDER/root, as
# its own apt gives them; the chroot stays as it is. 22 MB are fetched. Quick when they are there.
set -euo pipefail
chroot=${1:?usage: fetch_newest.sh CHROOT FOLDER}
folder=${2:?usage: fetch_newest.sh CHROOT FOLDER}
[ ! -e "$folder/root" ] || exit 0

mkdir -p "$folder"
work=$(mktemp -d "$folder/fetch.XXXXXX")
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/archives/partial"
cat >"$work/fetch.sh" <<'END'
version=$(dpkg-query -W -f '${Version}' libgl1-mesa-dri)
apt-get -qq -y -o APT::Sandbox::User=root -o Debug::NoLocking=true -o Dir::Cache::archives=/mnt/archives --download-only \
    --no-install-recommends install "mesa-drm-shim=$version" "mesa-vulkan-drivers=$version" python3-moderngl
END
unshare --mount sh -c 'mount --bind "$2" "$1/mnt" && chroot "$1" sh /mnt/fetch.sh' sh "$chroot" "$work" >&2
for package in "$work"/archives/*.deb; do
    dpkg-deb --extract "$package" "$work/root"
done
mv "$work/root" "$folder/root"
