# SPDX-License-Identifier: GPL-3.0-or-later
"""Light linking: the few combinations in a scene of what lights shine on and what stops their light, by number."""

import numpy as np

from ...scene.light_linking import ALL_SETS, LightLinking
from ...scene.lights import Light
from .light_records import LIGHT_LINK

NO_LINK = 0
"""The number of what shines on everything and is stopped by everything."""
_WORD = 0xFFFFFFFF


def _words(membership: int) -> tuple[int, int]:
    return membership & _WORD, (membership >> 32) & _WORD


class LightLinkTable:
    """Numbers for the memberships of lights and of instances that emit."""

    def __init__(self) -> None:
        self._numbers: dict[tuple[int, int], int] = {(ALL_SETS, ALL_SETS): NO_LINK}

    def of_light(self, light: Light) -> int:
        """The number of a light object's: one without shadows is stopped by nothing."""
        lit, shadows = self._memberships(light.linking)
        return self._number(lit, shadows if light.casts_shadow else 0)

    def of_emitter(self, linking: LightLinking | None) -> int:
        """The number of those of an instance that emits."""
        return self._number(*self._memberships(linking))

    @staticmethod
    def _memberships(linking: LightLinking | None) -> tuple[int, int]:
        if linking is None:
            return ALL_SETS, ALL_SETS
        return linking.light_set_membership, linking.shadow_set_membership

    def _number(self, lit: int, shadows: int) -> int:
        return self._numbers.setdefault((lit, shadows), len(self._numbers))

    @property
    def any(self) -> bool:
        """Whether there is a light that does not shine on everything, or is not stopped by everything."""
        return len(self._numbers) > 1

    @property
    def records(self) -> np.ndarray:
        """(n,) LIGHT_LINK records by number."""
        records = LIGHT_LINK.zeros(len(self._numbers))
        records["light_sets"] = [_words(lit) for lit, _ in self._numbers]
        records["shadow_sets"] = [_words(shadows) for _, shadows in self._numbers]
        return records
