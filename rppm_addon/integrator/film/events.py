# SPDX-License-Identifier: GPL-3.0-or-later
"""Events in a band of an iteration, and their listeners: passes, light groups and the noise estimate."""

from collections.abc import Iterable
from dataclasses import dataclass

from ..camera_paths.final_gather import FinalGather
from ..camera_paths.importons import Importons
from ..common.band import Band
from ..common.iteration import Iteration
from ..common.stage import Stage
from ..density_estimation.radii import Radii
from ..density_estimation.splat_sums import SplatSums
from ..device_scene.stage_context import StageContext
from ..direct_light.direct_light import DirectLight


@dataclass(frozen=True)
class BandEvents:
    """A band of an iteration, with the stages whose results its listeners read."""

    context: StageContext
    iteration: Iteration
    band: Band
    radii: Radii
    importons: Importons
    direct_light: DirectLight
    final_gather: FinalGather
    sums: SplatSums


class Listener(Stage):
    """A stage that the loop calls for its events. It need not listen to all of them."""

    def direct_light_found(self, events: BandEvents, segment: int) -> None:
        """Light of shadow rays was added to the camera paths of a segment, which are resolved and not yet scattered."""

    def paths_scattered(self, events: BandEvents, segment: int) -> None:
        """The camera paths of a segment have met emission, left importons and gone on."""

    def band_ended(self, events: BandEvents) -> None:
        """The radiance of a band is complete, in an iteration that enters the film."""


class Listeners:
    """Listeners, which are called in their order: those that come later may read what earlier ones wrote."""

    def __init__(self, listeners: Iterable[Listener]) -> None:
        self._listeners = tuple(listeners)

    def direct_light_found(self, events: BandEvents, segment: int) -> None:
        """Call Listener.direct_light_found of all."""
        for listener in self._listeners:
            listener.direct_light_found(events, segment)

    def paths_scattered(self, events: BandEvents, segment: int) -> None:
        """Call Listener.paths_scattered of all."""
        for listener in self._listeners:
            listener.paths_scattered(events, segment)

    def band_ended(self, events: BandEvents) -> None:
        """Call Listener.band_ended of all."""
        for listener in self._listeners:
            listener.band_ended(events)
