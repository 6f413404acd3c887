#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Builds FOLDER: Debian's development release with its Blender, an X server without a screen, and
# tools that press keys and take pictures; 1.4 GB, a few minutes. Quick when FOLDER is complete.
# The development release changes every day, and on some days its Blender cannot be installed or does not start: then
# what FOLDER had stays in use, or else an older release is taken. Ends with 77 and one line on why where none can be had.
set -euo pipefail
folder=${1:?usage: build_chroot.sh FOLDER}

releases=(sid testing trixie)
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

log=$folder.log
apt=(apt-get -qq -y --no-install-recommends -o Acquire::Check-Valid-Until=false -o Acquire::Retries=3
    -o Dpkg::Options::=--force-unsafe-io "-o" "Dpkg::Options::=--path-exclude=/usr/share/doc/*")

build() { # release: FOLDER.new with it; sets reason where it fails
    local release=$1
    echo "building Debian $release with Blender in $folder (a few minutes, 1.4 GB)"
    rm -rf --one-file-system "$folder.new"
    echo "== Debian $release" >>"$log"
    reason="debootstrap failed"
    debootstrap --variant=minbase "$release" "$folder.new" >>"$log" 2>&1 || return 1
    reason="the list of packages could not be fetched"
    in_chroot "${apt[@]}" update >>"$log" 2>&1 || return 1
    reason="packages could not be installed"
    in_chroot "${apt[@]}" install "${packages[@]}" >>"$log" 2>&1 || return 1
    in_chroot apt-get clean
    reason="Debian's Blender does not start"
    in_chroot blender --version >>"$log" 2>&1 || return 1
}

: >"$log"
for release in "${releases[@]}"; do
    if build "$release"; then
        echo "$wanted" >"$folder.new/rppm-complete"
        rm -rf --one-file-system "$folder"
        mv "$folder.new" "$folder"
        exit 0
    fi
    echo "Debian $release: $reason, see $log"
    if [ -s "$stamp" ]; then
        rm -rf --one-file-system "$folder.new"
        echo "the Blender window that was built before stays in use: $folder"
        exit 0
    fi
done
rm -rf --one-file-system "$folder.new"
give_up "$reason, see $log"
