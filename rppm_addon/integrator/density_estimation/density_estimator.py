# SPDX-License-Identifier: GPL-3.0-or-later
"""Density estimation: photons meet importons (Eq. 1) by one of two routes, which give the same sums bit for bit.

Splatting (splatting.py) rasterizes photons, as the paper does; importons gather from a photon grid (photon_grid.py).
"""

import logging
from collections.abc import Mapping
from weakref import WeakKeyDictionary

from ...gl.buffer_sets import Part
from ...gl.context.context import Context
from ...gl.context.timers import StageTimers
from ...gl.programs.programs import ProgramLibrary
from ...scene.settings import DensityEstimation, RenderSettings
from ..common.iteration import Iteration
from ..common.require import require
from ..common.stage import Stage
from ..common.stage_sizes import StageSizes
from .photon_grid import PhotonGrid
from .splat_sums import SplatSums, radiance_quantum
from .splatting import Splatting
from .stored_photons import PhotonList, SplatTargets, StoredPhotons

log = logging.getLogger(__name__)

_FEWEST_TO_TRY = 1000
"""Photons, and importons, to try both routes with."""
_WARM_UP_PHOTONS = 64
"""To compile with."""
_UNDECIDED = DensityEstimation.GRID
_faster: WeakKeyDictionary[ProgramLibrary, DensityEstimation] = WeakKeyDictionary()
"""The faster route once both were tried, by the open device's programs."""


ROUTES: Mapping[DensityEstimation, type[Splatting] | type[PhotonGrid]] = {
    DensityEstimation.RASTERIZED: Splatting,
    DensityEstimation.GRID: PhotonGrid,
}


def _may_rasterize(context: Context) -> bool:
    """Whether rasterization may be the faster route: where no unit rasterizes it takes 9 to 19 times as long as the
    grid, and the trial half of the first iteration."""
    return not context.is_software


class DensityEstimator(Stage):
    """Estimates densities at the importons of a band by the route that the settings ask for.

    AUTOMATIC takes the faster one: with the first photons and importons that are a thousand and more both are tried,
    but for software devices, on which the grid always is.
    """

    memory_group = "density estimation"
    photon_list = Part(PhotonList)
    sums = Part(SplatSums)

    def __init__(self, context: Context, library: ProgramLibrary, sizes: StageSizes) -> None:
        super().__init__(context, library, sizes)
        self._context, self._library, self._sizes = context, library, sizes
        self._wanted = DensityEstimation.AUTOMATIC
        self._routes: dict[DensityEstimation, Splatting | PhotonGrid] = {}
        self._prepared: DensityEstimation | None = None
        self._photons: StoredPhotons | None = None

    @property
    def route(self) -> DensityEstimation:
        """The one that is taken, which nothing but speed depends on."""
        if self._wanted is not DensityEstimation.AUTOMATIC:
            return self._wanted
        if not self._may_splat:
            return DensityEstimation.GRID
        return _faster.get(self._library, _UNDECIDED)

    def begin(
        self, settings: RenderSettings, photons: StoredPhotons, iteration: Iteration, medium_radius: float = 0.0
    ) -> None:
        """Take an iteration's photons. medium_radius: within which the sums take photons in media, meters. The quanta
        of small surfaces would be too coarse for these."""
        self._wanted, self._photons, self._prepared = settings.density_estimation, photons, None
        self.sums.count_in(
            radiance_quantum(photons.photon_flux, max(photons.radii.caustic, photons.radii.wide, medium_radius)),
            iteration.roulette_seed if settings.use_splat_roulette else 0,
            iteration.roulette_seed if iteration.precedes_learning else 0,
        )

    def prepare(self) -> None:
        """Bring the photons into the order that the route needs, unless that was done; release the other route."""
        route = self.route
        for other in self._routes.keys() - {route}:
            self.disown(self._routes.pop(other))
        if self._prepared is not route:
            self._get(route).prepare(require(self._photons))
            self._prepared = route

    def splat(self, importons: SplatTargets, timers: StageTimers) -> None:
        """DirectSplatting or IndirectSplatting: add to the sums what the photons give."""
        with timers.stage("indirect splatting" if importons.raster is None else "direct splatting"):
            photons = require(self._photons)
            if not photons.count or (importons.gathers and photons.indirect_count == photons.count):
                return
            if self._is_undecided:
                self._try_both(photons, importons)
            self.prepare()
            self._get(self.route).splat(photons, importons, self.sums)

    @property
    def _may_splat(self) -> bool:
        return self._photons is None or Splatting.holds(self._context, self._photons)

    @property
    def _is_undecided(self) -> bool:
        automatic = self._wanted is DensityEstimation.AUTOMATIC
        return automatic and self._library not in _faster and _may_rasterize(self._context) and self._may_splat

    def _try_both(self, photons: StoredPhotons, importons: SplatTargets) -> None:
        """Take the route that is faster with these importons, if they are many and take all photons.

        Nothing is added, and what contributes is marked as it will be anyway.
        """
        if importons.gathers or min(photons.count, importons.active.read_count()) < _FEWEST_TO_TRY:
            return
        self._prepared = None
        with self.sums.left_alone():
            self._seconds(DensityEstimation.GRID, photons.first(_WARM_UP_PHOTONS), importons)
            grid = self._get(DensityEstimation.GRID)
            if isinstance(grid, PhotonGrid) and grid.visited < _FEWEST_TO_TRY:
                return
            by_grid = self._seconds(DensityEstimation.GRID, photons, importons)
            # Ever more photons until it is clear, lest the trial take long where rasterization does.
            count, rasterized, growth = _WARM_UP_PHOTONS, 0.0, 16.0
            self._seconds(DensityEstimation.RASTERIZED, photons.first(count), importons)
            while rasterized <= by_grid and count < photons.count:
                count = min(int(growth * count), photons.count)
                rasterized = self._seconds(DensityEstimation.RASTERIZED, photons.first(count), importons)
                growth = min(max(1.5 * by_grid / rasterized, 2.0), 16.0)
        _faster[self._library] = DensityEstimation.RASTERIZED if rasterized <= by_grid else DensityEstimation.GRID
        log.debug(
            "density estimation: %.1f ms from the grid, %.1f ms rasterized with %d of %d photons",
            1e3 * by_grid, 1e3 * rasterized, count, photons.count,
        )  # fmt: skip

    def _seconds(self, name: DensityEstimation, photons: StoredPhotons, importons: SplatTargets) -> float:
        route = self._get(name)
        route.prepare(photons)  # buffers grow

        def run() -> None:
            route.prepare(photons)
            route.splat(photons, importons, self.sums)

        return self._context.seconds_of(run)

    def _get(self, route: DensityEstimation) -> Splatting | PhotonGrid:
        if route not in self._routes:
            with self._library.defining(self._sizes.features.defines):
                self._routes[route] = self.own(ROUTES[route](self._context, self._library, self._sizes))
        return self._routes[route]
