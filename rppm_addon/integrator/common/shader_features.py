# SPDX-License-Identifier: GPL-3.0-or-later
"""Features of scenes for which programs are compiled with code of their own."""

from dataclasses import dataclass

from ...materials.traits.ashikhmin_shirley import has_ashikhmin
from ...materials.traits.hair import has_hair
from ...materials.traits.interiors import Interior
from ...materials.traits.path_depths import asks_for_bounces_by_type
from ...materials.traits.ray_portals import has_ray_portals
from ...materials.traits.thin_films import has_thin_film
from ...scene.common.working_space import WorkingSpace
from ...scene.passes import ROUGHNESS
from ...scene.scene import Scene
from .viewport_demands import ViewportDemands


@dataclass(frozen=True)
class ShaderFeatures:
    """Features that a scene has. Programs for scenes without them are shorter and take less time to compile."""

    has_hair: bool = False
    """Whether materials scatter as fibers do."""
    has_ashikhmin: bool = False
    """Whether materials reflect by the model of Ashikhmin and Shirley."""
    has_portals: bool = False
    """Whether the world's light comes in through portals."""
    has_media: bool = False
    """Whether volumes fill the world or the inside of surfaces."""
    has_heterogeneous_media: bool = False
    """Whether any of these varies from place to place, or from object to object."""
    has_emissive_media: bool = False
    """True where volumes emit light."""
    counts_bounces: bool = False
    """Whether bounces are counted by type."""
    drops_caustics: bool = False
    """Whether any kind of caustics is left out."""
    clamps_light: bool = False
    """Whether light that paths bring has a limit."""
    has_spherical_stereo: bool = False
    """True where the camera stands to the side of each direction in which it looks."""
    has_transparent_glass: bool = False
    """True where the film's background shows behind clear glass."""
    shows_roughness: bool = False
    """True where the pass Roughness is rendered."""
    filters_glossy: bool = False
    """True where blurred bounces blur the lobes that they see."""
    has_ray_portals: bool = False
    """True where paths go on elsewhere behind some surfaces."""
    film_space: WorkingSpace | None = None
    """The space of the colors of thin films; None where no material has one."""

    @classmethod
    def of(cls, scene: Scene, demands: ViewportDemands) -> "ShaderFeatures":
        """Return the features of a scene, and those that a viewport demands."""
        volumes = [(scene.world.volume, False)]
        volumes += [(material.interior, material.reads_grids) for material in scene.materials]
        has_films = demands.has_thin_film or any(has_thin_film(material.graph) for material in scene.materials)
        interiors = [Interior.of(volume, reads_grids) for volume, reads_grids in volumes]
        return cls(
            demands.has_hair or any(has_hair(material.graph) for material in scene.materials),
            demands.has_ashikhmin or any(has_ashikhmin(material.graph) for material in scene.materials),
            any(light.is_portal for light in scene.lights),
            any(volume is not None for volume, _ in volumes),
            any(interior.varies for interior in interiors),
            any(interior.emission is not None for interior in interiors),
            scene.settings.limits_bounces_by_type
            or any(asks_for_bounces_by_type(material.graph) for material in scene.materials),
            scene.settings.dropped_caustics != 0,
            scene.settings.sample_clamp_direct > 0.0 or scene.settings.sample_clamp_indirect > 0.0,
            scene.camera.stereo is not None,
            scene.settings.film_transparent and scene.settings.film_transparent_glass,
            ROUGHNESS in scene.settings.rendered_passes,
            scene.settings.blur_glossy > 0.0,
            demands.has_ray_portals or any(has_ray_portals(material.graph) for material in scene.materials),
            scene.color_space if has_films else None,
        )

    @property
    def defines(self) -> dict[str, object]:
        """Macros of the features, for programs."""
        macros = {
            "HAIR_LOBES": self.has_hair,
            "ASHIKHMIN_LOBES": self.has_ashikhmin,
            "PORTALS": self.has_portals,
            "MEDIA": self.has_media,
            "HETEROGENEOUS_MEDIA": self.has_heterogeneous_media,
            "EMISSIVE_MEDIA": self.has_emissive_media,
            "COUNTS_BOUNCES": self.counts_bounces,
            "DROPS_CAUSTICS": self.drops_caustics,
            "CLAMPS_LIGHT": self.clamps_light,
            "SPHERICAL_STEREO": self.has_spherical_stereo,
            "TRANSPARENT_GLASS": self.has_transparent_glass,
            "ROUGHNESS_PASS": self.shows_roughness,
            "FILTERS_GLOSSY": self.filters_glossy,
            "RAY_PORTALS": self.has_ray_portals,
            "THIN_FILM_LOBES": self.film_space is not None,
        }
        of_films = {} if self.film_space is None else self.film_space.defines
        return of_films | {name: 1 for name, has in macros.items() if has}
