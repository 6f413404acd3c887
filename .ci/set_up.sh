#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Makes .venv with the pinned packages, installs what headless OpenGL needs on Debian, and unpacks a newer Mesa.
# Quick when all is there. PYTHON names the Python 3.11 to use.
set -euo pipefail
cd "$(dirname "$0")/.."
unset PYTHONDONTWRITEBYTECODE # compiling the programs imports, and so compiles, what rppm does

# Mesa's software and hardware drivers behind EGL, and the libraries that the bpy wheel links to.
system_packages=(
    libegl1 libegl-mesa0 libgl1-mesa-dri libgl1 libsm6 libice6 libxi6 libxfixes3 libxrender1
    libxxf86vm1 libxkbcommon0 libgomp1 glslang-tools
)

install_system_packages() {
    if ! command -v dpkg-query >/dev/null; then
        echo "set-up: not a Debian system: see .ci/set_up.sh for the libraries that OpenGL and Blender need" >&2
        return
    fi
    local missing=() package
    for package in "${system_packages[@]}"; do
        if [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" != installed ]; then
            missing+=("$package")
        fi
    done
    if [ ${#missing[@]} -eq 0 ]; then
        return
    fi
    if [ "$(id -u)" -ne 0 ]; then
        echo "set-up: system packages are missing and only root can install them. Run this, then make again:" >&2
        echo "    sudo apt-get install --no-install-recommends ${missing[*]}" >&2
        exit 1
    fi
    echo "set-up: installing ${missing[*]}"
    export DEBIAN_FRONTEND=noninteractive
    apt-get -qq update
    apt-get -qq -y install --no-install-recommends "${missing[@]}" >/dev/null
}

find_python() {
    local candidate
    for candidate in ${PYTHON:-} python3.11 python3; do
        if "$candidate" -c 'import sys; sys.exit(sys.version_info[:2] != (3, 11))' 2>/dev/null; then
            python=$candidate
            return
        fi
    done
    echo "set-up: Python 3.11 was not found (bpy 5.0.1 runs on no other); name it: make PYTHON=/path/to/python3.11" >&2
    exit 1
}

find_python
if [ ! -x .venv/bin/python ] && ! "$python" -c 'import ensurepip' 2>/dev/null; then
    system_packages+=(python3-venv)
fi
install_system_packages

install_python_packages() {
    local stamp=.venv/set-up-done wanted
    wanted=$(sha256sum pyproject.toml .ci/locks/setup.txt .ci/install_locked.py .ci/set_up.sh | sha256sum)
    if [ "$(cat "$stamp" 2>/dev/null)" = "$wanted" ]; then
        return
    fi
    echo "set-up: Python packages into .venv (Blender as a module among them: a few minutes the first time)"
    [ -x .venv/bin/python ] || "$python" -m venv .venv
    .venv/bin/python .ci/install_locked.py setup
    .venv/bin/python -m pip install --no-compile --quiet --disable-pip-version-check --root-user-action=ignore \
        --no-index --no-deps --no-build-isolation -e .
    echo "$wanted" >"$stamp"
}

install_python_packages
[ -e .mesa/release ] || .venv/bin/python .ci/unpack_mesa.py

# Drivers that render on the processor compile for longer than a first picture should take.
compile_programs() {
    local stamp=.venv/programs-compiled
    if [ "$stamp" -nt .mesa/release ]; then # also where there is no .mesa
        return
    fi
    echo "set-up: compiling the renderer's programs, once (a minute of processor time; five minutes at most)"
    timeout --kill-after=10 300 .venv/bin/rppm compile docs/samples/first_light.blend ||
        echo "set-up: not all of them are compiled; renders compile what they need"
    touch "$stamp"
}

compile_programs
