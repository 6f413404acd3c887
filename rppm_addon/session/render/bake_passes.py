# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures that Blender asks to be baked, made of the passes of a render."""

import enum
from dataclasses import dataclass

import numpy as np

from ...scene.errors import SettingsError
from .results import Frame


class BakeFilter(enum.IntFlag):
    """Contributions to a baked picture; the numbers are Blender's (BakeSettings.pass_filter)."""

    EMIT = 2
    DIFFUSE = 4
    GLOSSY = 8
    TRANSMISSION = 16
    DIRECT = 64
    INDIRECT = 128
    COLOR = 256


_LOBES = {
    "Diffuse": BakeFilter.DIFFUSE,
    "Glossy": BakeFilter.GLOSSY,
    "Transmission": BakeFilter.TRANSMISSION,
}
_LIGHT = {"Direct": BakeFilter.DIRECT, "Indirect": BakeFilter.INDIRECT}
_WHOLE = BakeFilter.EMIT | BakeFilter.DIRECT | BakeFilter.INDIRECT | sum(_LOBES.values(), BakeFilter(0))
_SINGLE = {
    "AO": "Ambient Occlusion",
    "POSITION": "Position",
    "NORMAL": "Normal",
    "UV": "UV",
    "ROUGHNESS": "Roughness",
    "EMIT": "Emission",
    "ENVIRONMENT": "Environment",
}
"""By type, the pass that is handed out as it is."""
_COMBINED = "COMBINED"
BAKE_TYPES = {
    _COMBINED: "Combined",
    **_SINGLE,
    **{name.upper(): name for name in _LOBES},
}
"""Labels in Cycles of the types that can be baked, by their names in Blender."""
ENVIRONMENT = "ENVIRONMENT"


@dataclass(frozen=True)
class BakePass:
    """A picture to be baked."""

    kind: str
    """One of BAKE_TYPES."""
    contents: BakeFilter = _WHOLE | BakeFilter.COLOR
    """Contributions that the picture contains, for types that consist of light."""

    @classmethod
    def of_blender(cls, pass_type: str, pass_filter: int) -> "BakePass":
        """Return the pass for the arguments of RenderEngine.bake. Raises SettingsError for a type not offered."""
        if pass_type not in BAKE_TYPES:
            offered = ", ".join(BAKE_TYPES.values())
            raise SettingsError(f"RPPM does not bake the type {pass_type}; choose one of {offered}, or use Cycles")
        return cls(pass_type, BakeFilter(pass_filter & (_WHOLE | BakeFilter.COLOR)))

    @property
    def _is_whole(self) -> bool:
        return self.kind == _COMBINED and self.contents & _WHOLE == _WHOLE

    @property
    def passes(self) -> tuple[str, ...]:
        """Names of the passes that the picture is made of, beside Combined."""
        if self.kind in _SINGLE:
            return (_SINGLE[self.kind],)
        if self._is_whole:
            return ()
        parts = [f"{lobe} {part}" for lobe in self._lobes for part in (*self._light, "Color")]
        seen = ["Environment"] if self.kind == _COMBINED else []
        return (*parts, *seen, *(["Emission"] if self._has_emission else []))

    @property
    def has_alpha(self) -> bool:
        """Whether transparency is part of the picture."""
        return self.kind == _COMBINED

    @property
    def is_denoised(self) -> bool:
        """Whether the picture is the one that denoisers take."""
        return self._is_whole

    @property
    def _has_emission(self) -> bool:
        return self.kind == _COMBINED and BakeFilter.EMIT in self.contents

    @property
    def _lobes(self) -> list[str]:
        if self.kind != _COMBINED:
            return [self.kind.title()]
        return [lobe for lobe, flag in _LOBES.items() if flag in self.contents]

    @property
    def _light(self) -> list[str]:
        return [part for part, flag in _LIGHT.items() if flag in self.contents]

    def picture(self, frame: Frame) -> np.ndarray:
        """(height, width, 4) float32 of a frame that has ``passes``; alpha 1 where it has no part in it."""
        picture = frame.combined.copy()
        if not self.has_alpha:
            picture[..., 3] = 1.0
        if not self._is_whole:
            picture[..., :3] = self._colors(frame)
        return picture

    def _colors(self, frame: Frame) -> np.ndarray:
        if self.kind in _SINGLE:
            shown = frame.passes[_SINGLE[self.kind]]
            return shown if shown.ndim == 3 else shown[..., None]
        colors = np.zeros_like(frame.combined[..., :3])
        for lobe in self._lobes:
            color = frame.passes[f"{lobe} Color"]
            light = sum((frame.passes[f"{lobe} {part}"] for part in self._light), np.zeros_like(color))
            if self.kind == _COMBINED or (self._light and BakeFilter.COLOR in self.contents):
                colors += light * color
            else:
                colors += light if self._light else color
        for name in self.passes:
            if name in ("Environment", "Emission"):
                colors += frame.passes[name]
        return colors
