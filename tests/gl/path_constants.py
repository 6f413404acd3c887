# SPDX-License-Identifier: GPL-3.0-or-later
"""Places, colors and roughness of the scenes of light path classes."""

import numpy as np
from path_quadrature import Plane

from rppm_addon.scene import DirectLight

SIZE = 24
"""Pixels along a side."""
MODES = RAYS, PHOTONS = tuple(DirectLight)
FIRST, SECOND, THIRD = np.array([0.9, 0.7, 0.5]), np.array([0.6, 0.8, 0.7]), np.array([0.8, 0.75, 0.9])
"""Colors of the surfaces in the order in which light meets them: a wrong number of bounces shows in the hue."""
CUT = 0.5
SHARP, TRACED, STORED = 0.2, 0.48, 0.52
"""Roughness that draws caustics, just below the cut-off, just above it."""
UP, DOWN = np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, -1.0])
FLOOR = Plane(np.zeros(3), UP)
WALL = Plane(np.array([1.2, 0.0, 0.0]), np.array([-1.0, 0.0, 0.0]))
FLOOR_AXES, WALL_AXES = np.eye(3)[:2], np.eye(3)[1:]
NARROW, WIDE = 0, 1
"""Indices into ProgressivePhotonMapper.splat_radii."""
