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
    """A stage that only reads what other stages of the loop compute, such as a pass.

    StageSet lists the listeners, and the loop calls them for its events. A listener implements the methods of the
    events that it needs.
    """

    def band_begun(self, events: BandEvents) -> None:
        """The camera paths of a band have found their first hits."""

    def medium_light_added(self, events: BandEvents, segment: int) -> None:
        """Shadow rays have added the direct light that media scatter along the rays of a segment of the camera paths,
        whose hits are resolved."""

    def direct_light_added(self, events: BandEvents, segment: int) -> None:
        """The hits of a segment of the camera paths are resolved, and shadow rays have added direct light to them; the
        paths are not scattered yet."""

    def paths_scattered(self, events: BandEvents, segment: int) -> None:
        """The camera paths of a segment have added emission, left importons and sampled their next rays."""

    def band_ended(self, events: BandEvents) -> None:
        """The radiance of a band is complete, in an iteration that enters the film."""


class Listeners:
    """Listeners in the order in which they are called: later ones may read what earlier ones wrote."""

    def __init__(self, listeners: Iterable[Listener]) -> None:
        self._listeners = tuple(listeners)

    def band_begun(self, events: BandEvents) -> None:
        """Call Listener.band_begun of all listeners."""
        for listener in self._listeners:
            listener.band_begun(events)

    def medium_light_added(self, events: BandEvents, segment: int) -> None:
        """Call Listener.medium_light_added of all listeners."""
        for listener in self._listeners:
            listener.medium_light_added(events, segment)

    def direct_light_added(self, events: BandEvents, segment: int) -> None:
        """Call Listener.direct_light_added of all listeners."""
        for listener in self._listeners:
            listener.direct_light_added(events, segment)

    def paths_scattered(self, events: BandEvents, segment: int) -> None:
        """Call Listener.paths_scattered of all listeners."""
        for listener in self._listeners:
            listener.paths_scattered(events, segment)

    def band_ended(self, events: BandEvents) -> None:
        """Call Listener.band_ended of all listeners."""
        for listener in self._listeners:
            listener.band_ended(events)
