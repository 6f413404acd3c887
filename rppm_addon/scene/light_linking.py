# SPDX-License-Identifier: GPL-3.0-or-later
"""Which objects light shines on and which ones stop it, by Blender's light and shadow linking."""

from dataclasses import dataclass, field

from .common.declared import declared

LIGHT_SETS = 64
"""Sets of objects that lights distinguish, at most; objects that nobody names are in set 0."""
ALL_SETS = -1
"""Memberships are the bits of 64-bit integers."""


@dataclass(frozen=True, slots=True)
class LightLinking:
    """Light and shadow linking of an object, as one that is lit and one that emits. Names and numbers are Cycles'."""

    receiver_light_set: int = field(default=0, metadata=declared(minimum=0, maximum=LIGHT_SETS - 1))
    """The set of objects to be lit that it is in."""
    blocker_shadow_set: int = field(default=0, metadata=declared(minimum=0, maximum=LIGHT_SETS - 1))
    """The set of objects to cast shadows that it is in."""
    light_set_membership: int = field(default=ALL_SETS, metadata=declared(minimum=-(1 << 63), maximum=(1 << 63) - 1))
    """Bits of the sets that its light shines on."""
    shadow_set_membership: int = field(default=ALL_SETS, metadata=declared(minimum=-(1 << 63), maximum=(1 << 63) - 1))
    """Bits of the sets that cast shadows in its light."""

    @property
    def lights_media(self) -> bool:
        """True where its light shines on media, which count as objects that nobody names."""
        return bool(self.light_set_membership & 1)
