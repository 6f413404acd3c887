#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Builds FOLDER: Debian's development release with its Blender, an X server without a screen, and
# tools that press keys and take pictures; 1.4 GB, a few minutes. Quick when FOLDER is complete.
# Ends with 77 and one line on why where it cannot be built.
set -euo pipefail
folder=${1:?usage: build_chroot.sh FOLDER}

release=sid
packages=(
    blender xvfb xauth xdotool imagemagick libgl1-mesa-dri libegl1 libegl-mesa0 libglx-mesa0
    python3-numpy python3-cattr python3-requests python3-zstandard
)

give_up() {
    echo "no Blender window: $1" >&2
    exit 77
}

# The packages' configuration runs in a mount namespace of its own, so that no mount outlives it.
in_chroot() {
    unshare --mount sh -c '
        set -e
        folder=$1
        shift
        mount -t proc proc "$folder/proc"
        mount --rbind /dev "$folder/dev"
        mount --make-rslave "$folder/dev"
        exec chroot "$folder" "$@"
    ' sh "$folder.new" env LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"
}

wanted=$(sha256sum "${BASH_SOURCE[0]}" | cut -d ' ' -f 1)
stamp=$folder/rppm-complete
[ "$(cat "$stamp" 2>/dev/null)" != "$wanted" ] || exit 0

[ "$(id -u)" -eq 0 ] || give_up "only root can build and enter a chroot"
unshare --mount true 2>/dev/null || give_up "this machine does not permit mount namespaces"
mkdir -p "$folder"
exec 9>"$folder.lock"
flock 9
[ "$(cat "$stamp" 2>/dev/null)" != "$wanted" ] || exit 0

if ! command -v debootstrap >/dev/null; then
    command -v apt-get >/dev/null || give_up "debootstrap is missing, and this is not a Debian system to install it"
    { apt-get -qq update && DEBIAN_FRONTEND=noninteractive apt-get -qq -y install --no-install-recommends debootstrap; } \
        >/dev/null || give_up "debootstrap is missing and could not be installed"
fi

echo "building Debian $release with Blender in $folder (a few minutes, 1.4 GB)"
log=$folder.log
rm -rf --one-file-system "$folder.new" "$folder"
debootstrap --variant=minbase "$release" "$folder.new" >"$log" 2>&1 || give_up "debootstrap failed, see $log"
apt=(apt-get -qq -y --no-install-recommends -o Acquire::Check-Valid-Until=false -o Acquire::Retries=3
    -o Dpkg::Options::=--force-unsafe-io "-o" "Dpkg::Options::=--path-exclude=/usr/share/doc/*")
in_chroot "${apt[@]}" update >>"$log" 2>&1 || give_up "the list of packages could not be fetched, see $log"
in_chroot "${apt[@]}" install "${packages[@]}" >>"$log" 2>&1 || give_up "packages could not be installed, see $log"
in_chroot apt-get clean
in_chroot blender --version >>"$log" 2>&1 || give_up "Debian's Blender does not start, see $log"
echo "$wanted" >"$folder.new/rppm-complete"
mv "$folder.new" "$folder"
