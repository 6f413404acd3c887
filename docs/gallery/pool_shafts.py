# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes pool_shafts.blend: shafts of sunlight below the waves of a deep pool."""

from pool_scenes import build_pool, pool
from stage import block, camera, color_world, save, set_up, sun
from volumes import absorbing, scattering, set_volume_bounces

pool.HALF_LENGTH, pool.HALF_WIDTH, pool.DEPTH = 2.6, 2.6, 2.4
LOWEST = pool.LEVEL - sum(wave[3] for wave in pool.WAVES)


def build(scene):
    build_pool((0.10, 0.26, 0.30), (0.06, 0.20, 0.25))
    # The medium is a body of its own and ends below the waves.
    murk = absorbing(scattering("Murk", (0.75, 0.95, 1.0), 0.16, 0.6), (0.2, 0.85, 0.95), 0.2)
    a, b, c = pool.HALF_LENGTH + 0.01, pool.HALF_WIDTH + 0.01, pool.DEPTH + 0.01
    block("Murk", (-a, -b, -c), (a, b, LOWEST), murk)
    sun((-0.35, -0.42, -0.85), 14.0)
    color_world(scene, (0.20, 0.50, 0.80), 0.30)
    camera((-1.2, -2.35, -1.75), (0.25, 1.2, -1.05), 20.0)
    set_up(scene, 640, 360)
    set_volume_bounces(scene, rppm=0, cycles=1)


if __name__ == "__main__":
    save(build)
