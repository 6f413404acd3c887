# SPDX-License-Identifier: GPL-3.0-or-later
"""Demands that a viewport makes on iterations and a final render does not."""

from dataclasses import dataclass

from ...scene.passes import (
    DENOISING_ALBEDO,
    DENOISING_DEPTH,
    DENOISING_NORMAL,
    FILM_PASSES,
    RenderPass,
)

GUIDES = (DENOISING_ALBEDO, DENOISING_NORMAL, DENOISING_DEPTH)
"""Passes by which a picture of few samples is filtered, by name."""
SEEN_LIGHT = ("Emission", "Environment")
"""Passes of light that has no noise to be filtered."""
FILTERED_PASSES = (*GUIDES, *SEEN_LIGHT)
"""Passes that a film keeps for the noise filter, by name."""


@dataclass(frozen=True)
class ViewportDemands:
    """For pictures of few pixels and samples; a final render has none."""

    shadow_rays: int = 1
    """Shadow rays of each vertex of a camera path. Their lights are stratified, so that several find every kind of
    light."""
    is_filtered: bool = False
    """Whether the film keeps what the noise filter takes."""
    has_subsurface: bool = False
    has_hair: bool = False
    has_ashikhmin: bool = False
    has_ray_portals: bool = False
    has_thin_film: bool = False
    traces_rays: bool = False
    casts_rays: bool = False
    """Whether programs are to be ready for light that goes below surfaces, for fibers, for Ashikhmin and Shirley's
    model, for ray portals, for thin films, for rays of nodes, and among these for such as begin anywhere, which
    materials have that something stands in for as yet."""


NO_DEMANDS = ViewportDemands()


def with_filtered(passes: tuple[RenderPass, ...]) -> tuple[RenderPass, ...]:
    """Passes with those that a film keeps for the noise filter, in the table's order; others after them."""
    kept = (entry for entry in FILM_PASSES if entry in passes or entry.name in FILTERED_PASSES)
    return (*kept, *(entry for entry in passes if entry not in FILM_PASSES))
