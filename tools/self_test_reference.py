# SPDX-License-Identifier: GPL-3.0-or-later
"""Render the picture that rppm doctor compares with: python tools/self_test_reference.py [SAMPLES]."""

import sys

import numpy as np

from rppm_addon.self_test.checks import REFERENCE, differences, reference, reference_scene
from rppm_addon.session.render.renderer import Renderer

SAMPLES = 4096


def main() -> None:
    """Write the reference, and say how far it is from the one before."""
    samples = int(sys.argv[1]) if len(sys.argv) > 1 else SAMPLES
    with Renderer() as renderer:
        seen = renderer.render(reference_scene(samples, seed=1)).frame.combined[..., :3].astype(np.float32)
    if REFERENCE.is_file():
        mean, worst = differences(seen, reference())
        print(f"mean {mean:+.3%}, blocks at most {worst:.2%} from the reference before")
    np.savez_compressed(REFERENCE, radiance=seen)


if __name__ == "__main__":
    main()
