# SPDX-License-Identifier: GPL-3.0-or-later
"""The Glossy BSDF with the distribution of Ashikhmin and Shirley: rough enough to store photons, and stretched."""

from ...net import socket
from ..rows import lit

GROUP = "Ashikhmin-Shirley"


def _glossy(inputs):
    return socket("BsdfAnisotropic", 0, {"Color": (0.8, 0.45, 0.3)} | inputs, distribution="ASHIKHMIN_SHIRLEY")


lit(GROUP, "roughness 0.8", _glossy({"Roughness": 0.8}))
lit(GROUP, "roughness 0.1", _glossy({"Roughness": 0.1}), effort=2)
lit(GROUP, "anisotropy 0.7, rotated", _glossy({"Roughness": 0.4, "Anisotropy": 0.7, "Rotation": 0.1}), effort=2)
