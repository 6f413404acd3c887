#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs a command inside CHROOT, read-only, with FOLDER as its /mnt, and in namespaces of its own: what it starts ends
# with it, and its /dev/shm, /tmp, network and display numbers are its own.
set -eu
if [ "$1" != --inside ]; then
    exec unshare --mount --pid --net --ipc --fork --kill-child "$0" --inside "$@"
fi
chroot=$2
folder=$3
shift 3
mount --bind "$chroot" "$chroot"
mount -o remount,bind,ro "$chroot"
mount -t proc proc "$chroot/proc"
mount --rbind /dev "$chroot/dev"
mount -t tmpfs -o mode=1777 tmpfs "$chroot/dev/shm"
for place in tmp run var/tmp; do
    mount -t tmpfs -o mode=1777 tmpfs "$chroot/$place"
done
mount --bind "$folder" "$chroot/mnt"
exec chroot "$chroot" env -i PATH=/usr/bin:/bin LC_ALL=C.UTF-8 HOME=/mnt/home "$@"
