# SPDX-License-Identifier: GPL-3.0-or-later
"""Algorithm 1 of the paper, Rasterization-based Progressive Photon Mapping. Its Init is in device_scene.py."""

from collections.abc import Iterator

from .common.band import Band
from .common.iteration import Iteration
from .density_estimation.radii import Radii
from .device_scene.stage_context import StageContext
from .learning import BandFindings, Learning
from .stages.gbuffer import jittered_view
from .stages.stage_set import StageSet


def iterate(context: StageContext, stages: StageSet, learning: Learning, iteration: Iteration) -> Iterator[None]:
    """One iteration in steps, for whoever has something to do between them. The paper's names stand beside."""
    importons, camera_hits = stages.importons, stages.camera_hits
    estimator, film, light, groups = stages.density_estimator, stages.film, stages.light_passes, stages.light_groups
    yield from trace_photons(context, stages, iteration)
    radii = store_photons(context, stages, learning, iteration)
    findings: list[BandFindings] = []
    stages.photon_noise.begin()
    yield
    for band in stages.bands:
        stages.clear(context)
        context = context.with_blocks(stages.blocks_of(band))
        view = jittered_view(context.scene.camera, context.settings, band, iteration)
        camera_hits.find(context, importons, view, band)  # DirectCameraHits
        stages.media.enter_camera_paths(context, importons, iteration)
        yield
        for segment in range(context.settings.camera_segments):  # TraceImportons
            if segment > 0 and not importons.trace(context, segment):
                break
            stages.photon_noise.count(importons, iteration)
            importons.resolve(context, iteration, segment)
            stages.subsurface.walk_camera_paths(context, importons, band, segment)
            yield
            stages.shadow_catcher.cast(context, importons, band, segment)
            stages.direct_light.add(context, importons, band, iteration, segment)
            yield
            film.add_passes(context, importons, band, iteration, segment)
            film.add_caught_shadows(context, importons, band, iteration, segment)
            light.add_direct_light(context, importons, stages.direct_light, film, band, iteration, segment)
            groups.add_direct_light(context, importons, stages.direct_light, iteration)
            importons.scatter(context, band, segment)
            film.add_seen_light(context, importons, band, iteration, segment)
            groups.add_seen_light(context, importons, iteration)
            stages.coverage.probe(context, importons, band, segment)
            raster = camera_hits.raster(band) if segment == 0 and not stages.subsurface.is_used else None
            estimator.splat(importons.taking(context, segment, raster), context.timers)  # Direct-, IndirectSplatting
            yield
        if iteration.needs_radiance:
            stages.final_gather.share(context, estimator.sums, importons.radiances, band, radii)
        if iteration.enters_film:  # UpdatePPMParams; the radii follow from the iteration's number (Eq. 2)
            film.accumulate(context, importons.radiances, estimator.sums, band)
            film.add_aovs(context, importons, band)
            stages.noise_estimate.add(context, importons.radiances, estimator.sums, band, iteration)
            light.add_indirect_light(context, importons, stages.final_gather, estimator.sums, film, band, radii)
            groups.accumulate(context, stages.final_gather, estimator.sums, film, band, radii)
        if iteration.precedes_learning:
            findings.append(_read_findings(context, stages, learning, band, iteration, radii))
    _learn(context, stages, learning, iteration, findings)
    yield


def trace_photons(context: StageContext, stages: StageSet, iteration: Iteration) -> Iterator[None]:
    """DirectPhotonHits and TracePhotons, in steps."""
    context.begin(iteration)
    photons = stages.photons
    photons.emit(context, iteration)
    stages.media.enter_photons(context, photons, iteration)
    for segment in range(context.settings.photon_segments):
        if segment > 0 and not photons.trace(context, segment):
            break
        photons.resolve(context, iteration, segment)
        photons.scatter(context, stages.subsurface, iteration, segment)
        yield


def store_photons(context: StageContext, stages: StageSet, learning: Learning, iteration: Iteration) -> Radii:
    """Offer the photons that were stored to the importons; returns the radii within which these take them."""
    estimator = stages.density_estimator
    listed = stages.photons.list_stored(context, estimator.photon_list, iteration)
    radii = learning.radii_for(iteration, listed)
    context.iteration_block.write_radii(radii)
    estimator.begin(context.settings, stages.photons.stored(context, listed, radii), iteration)
    return radii


def _read_findings(
    context: StageContext, stages: StageSet, learning: Learning, band: Band, iteration: Iteration, radii: Radii
) -> BandFindings:
    """Read what a band tells of its photons, once nothing needs the radiances of the band any more."""
    sums, fraction = stages.density_estimator.sums, learning.photon_fraction(iteration)
    taken = sums.photons_taken(band.pixel_count)
    stages.caustic_radii.narrow(context.blocks, sums, band, radii, fraction, context.timers)
    if not iteration.weighs_noise:
        return BandFindings(taken)
    gather, importons = stages.final_gather, stages.importons
    return BandFindings(taken, stages.photon_noise.sample(context, importons, gather, sums, band, radii))


def _learn(
    context: StageContext, stages: StageSet, learning: Learning, iteration: Iteration, findings: list[BandFindings]
) -> None:
    if iteration.is_tallied:
        learning.tally(context, stages.photons, findings)
    if iteration.weighs_noise:
        learning.weigh_noise(iteration, stages.photons, stages.photon_noise.vertices, findings)
