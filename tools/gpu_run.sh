#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What is to be known once a GPU can be had for an hour, on a machine without network: GL tests, pictures beside
# llvmpipe's, seconds by stage, those of every program beside what was predicted (docs/benchmarks/predictions.md), and
# the figures of make bench.
#
#   tools/gpu_run.sh prepare [FOLDER]          # here: wheels, scenes and llvmpipe's pictures into build/gpu
#   tools/gpu_run.sh run [FOLDER] [RESULTS]    # there, in a copy of the checkout with FOLDER: results into out/gpu
#
# PYTHON names the interpreter there; PYTHON_VERSION (3.12) is what the wheels are for. QUICK=1 takes the least of each,
# to try the script itself. Each part ends after SECONDS_EACH (240) seconds and says so; what others found stays.
# Copy RESULTS/benchmarks/DEVICE to docs/benchmarks/ here, and draw: make bench BENCH=--plot.
set -uo pipefail
cd "$(dirname "$0")/.."
verb=${1:-}
folder=${2:-build/gpu}
results=${3:-out/gpu}
scenes=(first_light pool spotlight)
resolution=${QUICK:+48x32}
resolution=${resolution:-640x480}
samples=${QUICK:+2}
samples=${samples:-16}

render() { # python, scene, picture, report
    "$1" -m rppm_addon render "$folder/scenes/$2.npz" -o "$3" --json "$4" --resolution "$resolution" \
        --samples "$samples" --set rppm.time_limit=0
}

prepare() {
    set -e
    mkdir -p "$folder"/{wheels,scenes,pictures}
    local version=${PYTHON_VERSION:-3.12} platforms=() number
    for number in 2014 1; do platforms+=(--platform "manylinux${number}_x86_64"); done
    for number in 17 24 27 28 31 34; do platforms+=(--platform "manylinux_2_${number}_x86_64"); done
    # The lock is that of Python 3.12; another Python may lack wheels of these versions, and pip says which.
    .venv/bin/python -m pip download --quiet --disable-pip-version-check --only-binary=:all: --require-hashes --no-deps \
        --python-version "$version" --implementation cp "${platforms[@]}" -d "$folder/wheels" -r .ci/locks/gpu.txt
    [ -n "${QUICK:-}" ] || .venv/bin/python -m benchmarks.device.run --export-only \
        --saved-scenes "$folder/benchmark_scenes" || echo "scenes outside the repository are left out" >&2
    for scene in "${scenes[@]}"; do
        .venv/bin/python -m rppm_addon export "docs/samples/$scene.blend" -o "$folder/scenes/$scene.npz"
        render .venv/bin/python "$scene" "$folder/pictures/$scene.exr" "$folder/pictures/$scene.json"
    done
    du -sh "$folder"
}

part() { # name, command...: its output into RESULTS/name.log
    local name=$1 start=$SECONDS status=0
    shift
    timeout --kill-after=10 "${SECONDS_EACH:-240}" bash -c '"$@"' part "$@" >"$results/$name.log" 2>&1 || status=$?
    echo "$name: $((SECONDS - start)) s, $([ $status -eq 0 ] && echo ended well || echo "ended with code $status")" |
        tee -a "$results/parts.txt"
}

compare() { # python, scene
    "$1" - "$folder/pictures/$2.exr" "$results/$2.exr" <<'END'
"""Means and relative difference of blocks of 8 x 8 pixels: other devices round otherwise, and see the same light."""
import sys

import numpy as np

from rppm_addon.pictures import read_exr

first, second = (read_exr(path).combined[..., :3].astype(np.float64) for path in sys.argv[1:])
rows, columns = (side // 8 * 8 for side in first.shape[:2])
blocks = [p[:rows, :columns].reshape(rows // 8, 8, columns // 8, 8, 3).mean((1, 3)) for p in (first, second)]
difference = np.abs(blocks[0] - blocks[1]) / (np.abs(blocks[0]) + 0.01)
print(f"means {first.mean():.6f} and {second.mean():.6f}; blocks differ by {np.median(difference):.2e} (median),")
print(f"{difference.max():.2e} (most); equal bit for bit: {np.array_equal(first, second)}")
sys.exit(not abs(second.mean() / first.mean() - 1.0) < 0.02)
END
}

run() {
    local python=${PYTHON:-python3} site=$PWD/$folder/site scene
    mkdir -p "$results"
    : >"$results/parts.txt"
    if [ -z "${PYTHON:-}" ]; then
        "$python" -m pip install --quiet --no-index --no-deps --no-compile --upgrade --target "$site" "$folder"/wheels/*.whl || exit 1
        export PYTHONPATH=$PWD:$site
    else
        export PYTHONPATH=$PWD
    fi
    export RPPM_CACHE=${RPPM_CACHE:-$PWD/$results/programs}
    part device "$python" -m rppm_addon info --json "$results/device.json"
    [ -n "${QUICK:-}" ] || part doctor "$python" -m rppm_addon doctor -o "$results/doctor.txt"
    # Cold first: what users wait for once; then as it is from then on, seconds by stage in the JSON.
    for scene in "${scenes[@]}"; do
        part "cold_$scene" render "$python" "$scene" "$results/$scene.exr" "$results/$scene.cold.json"
        part "warm_$scene" render "$python" "$scene" "$results/$scene.exr" "$results/$scene.json"
        part "pictures_$scene" compare "$python" "$scene"
    done
    part predictions "$python" -m benchmarks.predictions.run "$folder/scenes/pool.npz" --measure \
        ${QUICK:+--pixels 1024 --iterations 1}
    local tests=(tests/gl/gl/test_gl_layer.py)
    [ -n "${QUICK:-}" ] || tests=(tests/gl)
    part tests "$python" -m pytest -q -p no:cacheprovider -m 'not long' "${tests[@]}"
    local figures=(--saved-scenes "$folder/benchmark_scenes" --output "$results/benchmarks")
    [ -z "${QUICK:-}" ] || figures+=(--quick --figures construction --scenes room_1k)
    part figures "$python" -m benchmarks.device.run "${figures[@]}"
    rm -rf "$results/programs"
    cat "$results/parts.txt"
    ! grep -q "ended with" "$results/parts.txt"
}

export folder results resolution samples
export -f render compare
case $verb in
prepare | run) "$verb" ;;
*)
    sed -n '3,14s/^# \{0,1\}//p' "$0"
    exit 2
    ;;
esac
