# SPDX-License-Identifier: GPL-3.0-or-later
"""Algorithm 1 of the paper, Rasterization-based Progressive Photon Mapping. Its Init is in device_scene.py."""

from collections.abc import Iterator, Sequence

from .camera_paths.gbuffer import jittered_view
from .common.band import Band
from .common.iteration import Iteration
from .density_estimation.radii import Radii
from .device_scene.stage_context import StageContext
from .film.events import BandEvents
from .learning import BandFindings, Learning
from .stage_set import StageSet


def iterate(
    context: StageContext,
    stages: StageSet,
    learning: Learning,
    iteration: Iteration,
    bands: Sequence[tuple[Band, Iteration]],
) -> Iterator[None]:
    """One iteration in steps, for whoever has something to do between them. The paper's names stand beside.

    bands: those that take part in the iteration, with the iteration as it is for each."""
    importons, estimator, listeners = stages.importons, stages.density_estimator, stages.listeners
    yield from trace_photons(context, stages, iteration)
    radii = store_photons(context, stages, learning, iteration)
    findings: list[BandFindings] = []
    stages.photon_noise.begin()
    yield
    for band, exposure in bands:
        context.iteration_block.write_number_in_film(exposure.number_in_film)
        stages.clear(context)
        context = context.with_blocks(stages.blocks_of(band))
        view = jittered_view(context.scene.camera, context.settings, band, exposure)
        events = stages.events_of(context, exposure, band, radii)
        stages.camera_hits.find(context, importons, view, band)  # DirectCameraHits
        stages.media.enter_camera_paths(context, importons)
        listeners.band_begun(events)
        yield
        for segment in range(context.settings.camera_segments):  # TraceImportons
            if segment > 0 and not importons.trace(context, segment):
                break
            importons.resolve(context, exposure, segment)
            stages.subsurface.walk_camera_paths(context, importons, band, segment)
            yield
            if stages.media.is_on:
                _add_scattering_in_media(context, stages, events, segment)
                yield
            stages.shadow_catcher.cast(context, importons, band, segment)
            stages.direct_light.add(context, importons, band, exposure, segment)
            yield
            listeners.direct_light_added(events, segment)
            importons.scatter(context, band, segment)
            stages.medium_scattering.leave_vertices(context, importons)
            listeners.paths_scattered(events, segment)
            stages.coverage.probe(context, importons, band, segment)
            raster = stages.camera_hits.raster(band) if segment == 0 and not stages.subsurface.is_on else None
            targets = importons.splat_targets(context, segment, raster)
            estimator.splat(targets, context.timers)  # Direct-, IndirectSplatting
            yield
        if exposure.needs_radiance:
            stages.final_gather.add(context, estimator.sums, importons.radiances, band, radii)
        if exposure.enters_film:  # UpdatePPMParams; the radii follow from the iteration's number (Eq. 2)
            listeners.band_ended(events)
        if exposure.precedes_learning:
            findings.append(_read_findings(events, stages, learning))
    _learn(context, stages, learning, iteration, findings)
    yield


def _add_scattering_in_media(context: StageContext, stages: StageSet, events: BandEvents, segment: int) -> None:
    """Add the light that media scatter toward the camera along the rays of a segment: direct light by shadow rays, and
    all other light by photon beams, where rays come straight from the camera through thin media, or by photons."""
    importons, band, sums, beams = events.importons, events.band, events.sums, stages.photon_beams
    photon_map = stages.medium_photons
    stages.medium_scattering.scatter_camera_paths(context, importons, beams, photon_map, band, segment)
    if stages.direct_light.add_in_media(context, importons, band, events.iteration, segment):
        stages.listeners.medium_light_added(events, segment)
    raster = stages.camera_hits.raster(band)
    beams.splat(context, stages.photons, importons, sums, raster, segment)
    beams_from = beams.least_free_path if beams.draws(raster, segment) else None
    photon_map.gather(context, importons, sums, band, segment, beams_from)


def trace_photons(context: StageContext, stages: StageSet, iteration: Iteration) -> Iterator[None]:
    """DirectPhotonHits and TracePhotons, in steps."""
    context.begin(iteration)
    photons = stages.photons
    photons.emit(context, iteration)
    stages.media.enter_photons(context, photons, iteration)
    stages.photon_beams.clear(stages.media.volume)
    for segment in range(context.settings.photon_segments):
        if segment > 0 and not photons.trace(context, segment):
            break
        stages.medium_scattering.scatter_photons(context, photons, stages.photon_beams, stages.media.reach, segment)
        photons.resolve(context, iteration, segment)
        photons.scatter(context, stages.subsurface, iteration, segment)
        yield


def store_photons(context: StageContext, stages: StageSet, learning: Learning, iteration: Iteration) -> Radii:
    """Offer the photons that were stored to the importons; returns the radii within which these take them."""
    estimator = stages.density_estimator
    listed = stages.photons.list_stored(context, estimator.photon_list)
    radii = learning.radii_for(iteration, listed)
    context.iteration_block.write_radii(radii)
    stages.medium_photons.build(context, stages.photons, iteration, stages.media.volume, stages.media.reach)
    stages.photon_beams.prepare(context, iteration)
    stored, in_media = stages.photons.stored(context, listed, radii), stages.medium_photons
    estimator.begin(context.settings, stored, iteration, in_media.radius if in_media.photon_count else 0.0)
    return radii


def _read_findings(events: BandEvents, stages: StageSet, learning: Learning) -> BandFindings:
    """Read what is learned from the photons of a band, once nothing needs the radiances of the band any more."""
    context, sums, band = events.context, events.sums, events.band
    taken, fraction = sums.photons_taken(band.pixel_count), learning.photon_fraction(events.iteration)
    stages.caustic_radii.narrow(context.blocks, sums, band, events.radii, fraction, context.timers)
    if not events.iteration.weighs_noise:
        return BandFindings(taken)
    return BandFindings(taken, stages.photon_noise.sample(events))


def _learn(
    context: StageContext, stages: StageSet, learning: Learning, iteration: Iteration, findings: list[BandFindings]
) -> None:
    if iteration.is_tallied:
        learning.tally(context, stages.photons, findings)
    if iteration.weighs_noise:
        pairs_in_media = stages.medium_photons.count_pairs(), stages.photon_beams.count_pairs()
        learning.weigh_noise(iteration, stages.photons, stages.photon_noise.vertices, findings, pairs_in_media)
