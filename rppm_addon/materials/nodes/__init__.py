# SPDX-License-Identifier: GPL-3.0-or-later
"""Kinds of nodes by name; a module a family."""

from . import color, curves, geometry, hair, images, math, shaders, spectrum, stand_in, textures, view, volumes
from .node_kinds import NodeKind

KINDS: dict[str, NodeKind] = {}
for _family in (color, curves, geometry, hair, images, math, shaders, spectrum, stand_in, textures, view, volumes):
    for _name, _kind in _family.KINDS.items():
        if _name in KINDS:
            raise ValueError(f"node kind {_name} is declared twice")
        KINDS[_name] = _kind
