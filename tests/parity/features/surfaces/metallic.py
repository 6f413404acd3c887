# SPDX-License-Identifier: GPL-3.0-or-later
"""The Metallic BSDF."""

from ...net import socket
from ..rows import lit

GROUP = "Metallic"
FILM = {"Roughness": 0.2, "Thin Film Thickness": 400.0}


def _metallic(inputs, **properties):
    return socket("BsdfMetallic", 0, inputs, **properties)


lit(GROUP, "plain", _metallic({"Roughness": 0.3}))
lit(GROUP, "thin film", _metallic(FILM))
lit(GROUP, "thin film, rough", _metallic(FILM | {"Roughness": 0.6}))
lit(GROUP, "thin film, F82", _metallic(FILM | {"Thin Film IOR": 1.6}, fresnel_type="F82"))
