# SPDX-License-Identifier: GPL-3.0-or-later
"""Denoised pictures, by the first library that can be opened."""

import logging
from collections.abc import Mapping, Sequence

import numpy as np

from ..scene.errors import DenoiserError
from ..scene.passes import DENOISING_ALBEDO, DENOISING_NORMAL
from ..scene.settings import DenoisingPrefilter, RenderSettings
from .library import OpenImageDenoise
from .places import REMEDY, LibraryPlace

log = logging.getLogger(__name__)

_FEATURES = {DENOISING_ALBEDO: "albedo", DENOISING_NORMAL: "normal"}
"""Names in the library of the passes that guide denoising, by pass."""
_BRIGHTEST = 65504.0
"""In place of what is infinite: the end of the half floats that the library computes with."""


class Denoiser:
    """Opens a library when the first picture is to be denoised, and keeps it."""

    def __init__(self, places: Sequence[LibraryPlace]) -> None:
        """places: libraries in the order in which they are tried."""
        self._places = list(places)
        self._library: OpenImageDenoise | None = None
        self._on_gpu: OpenImageDenoise | None = None
        """The same library on a GPU, once that is asked for; on the processor where it knows none."""
        self._place: LibraryPlace | None = None
        self._problem = ""

    def open(self) -> OpenImageDenoise:
        """The first library that can be used. Raises DenoiserError, saying what to do, where there is none."""
        if self._library is not None:
            return self._library
        if not self._problem:
            reasons = []
            for place in self._places:
                try:
                    self._library, self._place = OpenImageDenoise(place.path), place
                except DenoiserError as error:
                    log.warning("%s", error)
                    reasons.append(str(error))
                    continue
                return self._library
            why = f" ({'; '.join(reasons)})" if reasons else ""
            self._problem = f"Open Image Denoise is not there{why}: {REMEDY}"
        raise DenoiserError(self._problem)

    def _open_on_gpu(self) -> OpenImageDenoise:
        """Return the library that open gives, on a GPU where it can use one. Raises DenoiserError as open does."""
        if self._on_gpu is None:
            self._on_gpu = library = self.open()
            try:
                self._on_gpu = OpenImageDenoise(library.path, use_gpu=True)
            except DenoiserError as error:
                log.warning("%s; the processor denoises", error)
            log.info("Open Image Denoise runs on %s", self._on_gpu.device_name)
        return self._on_gpu

    @property
    def description(self) -> str:
        """Version, source and file of the library. Raises DenoiserError as open does."""
        library = self.open()
        assert self._place is not None
        return f"Open Image Denoise {library.version} of {self._place.source.value}, {self._place.path}"

    def denoise(self, combined: np.ndarray, passes: Mapping[str, np.ndarray], settings: RenderSettings) -> np.ndarray:
        """A picture without its noise.

        Args:
            combined: (height, width, 4) float32 scene-linear, premultiplied alpha.
            passes: those of the film by name; the ones that guide are taken.
            settings: how, by the fields ``denoising_``.

        Returns:
            (height, width, 4) float32; alpha is left as it is, as in Cycles.

        Raises:
            DenoiserError: there is no library, or it fails.
        """
        library = self._open_on_gpu() if settings.denoising_use_gpu else self.open()
        quality, prefilter = settings.denoising_quality, settings.denoising_prefilter
        features = {
            name: np.nan_to_num(passes[entry])
            for entry, name in _FEATURES.items()
            if entry in settings.denoising_features
        }
        if prefilter is DenoisingPrefilter.ACCURATE:
            features = {name: library.filter({name: feature}, quality) for name, feature in features.items()}
        color = np.nan_to_num(combined[..., :3], nan=0.0, posinf=_BRIGHTEST, neginf=0.0)
        result = np.empty_like(combined)
        result[..., :3] = library.filter(
            {"color": color, **features}, quality, hdr=True, clean_features=prefilter is not DenoisingPrefilter.FAST
        )
        result[..., 3] = combined[..., 3]
        return result
