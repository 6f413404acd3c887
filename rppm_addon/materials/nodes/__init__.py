# SPDX-License-Identifier: GPL-3.0-or-later
"""All kinds of nodes by name."""

from ..node_kinds import NodeKind
from . import geometry, images, shaders

KINDS: dict[str, NodeKind] = {}
for _family in (geometry, images, shaders):
    for _name, _kind in _family.KINDS.items():
        if _name in KINDS:
            raise ValueError(f"node kind {_name} is declared twice")
        KINDS[_name] = _kind
