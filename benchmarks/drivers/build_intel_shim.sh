#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Builds drm-shim for Intel's driver, which Debian leaves out of its package, from Mesa's sources: FOLDER/intel/.
# A minute of processor time; 60 MB are fetched, 600 MB are needed while it builds. Quick when it is there.
set -euo pipefail
folder=${1:-${RPPM_DRIVERS:-${XDG_CACHE_HOME:-$HOME/.cache}/rppm-drivers}}
cd "$(dirname "$0")/../.."
name=libintel_noop_drm_shim.so
[ ! -e "$folder/intel/$name" ] || exit 0

packages=(gcc ninja-build pkg-config bison flex libdrm-dev libexpat1-dev zlib1g-dev)
missing=()
for package in "${packages[@]}"; do
    dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
done
if [ ${#missing[@]} -gt 0 ]; then
    if [ "$(id -u)" -ne 0 ]; then
        echo "run first: sudo apt-get install --no-install-recommends ${missing[*]}" >&2
        exit 1
    fi
    apt-get -qq update
    DEBIAN_FRONTEND=noninteractive apt-get -qq -y install --no-install-recommends "${missing[@]}" >/dev/null
fi

mkdir -p "$folder"
work=$(mktemp -d "$folder/build.XXXXXX")
trap 'rm -rf "$work"' EXIT
.venv/bin/python .ci/unpack_mesa.py --source "$work/mesa"
.venv/bin/python -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check meson mako pyyaml packaging
export PATH="$work/venv/bin:$PATH"
# Nothing but the shim, unoptimized: it answers questions, and no driver is built.
options=(-Dbuildtype=plain -Dtools=drm-shim,intel -Dgallium-drivers= -Dvulkan-drivers= -Dplatforms= -Dopengl=false
    -Dintel-rt=disabled -Dintel-clc=system -Dexpat=enabled)
for feature in glx egl gbm gles1 gles2 llvm zstd valgrind libunwind glvnd xmlconfig shader-cache; do
    options+=("-D$feature=disabled")
done
meson setup "$work/build" "$work/mesa" "${options[@]}" >"$folder/intel.log"
ninja -C "$work/build" "src/intel/tools/$name" >>"$folder/intel.log"
mkdir -p "$folder/intel"
mv "$work/build/src/intel/tools/$name" "$folder/intel/"
