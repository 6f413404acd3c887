# SPDX-License-Identifier: GPL-3.0-or-later
"""Colors by temperature and by wavelength."""

from .node_kinds import COLOR, FLOAT, NodeKind

KINDS = {
    "blackbody": NodeKind("spectrum.glsl", {"temperature": (FLOAT, 6500.0)}, {"color": COLOR}),
    "wavelength": NodeKind("spectrum.glsl", {"wavelength": (FLOAT, 500.0)}, {"color": COLOR}),
}
