# SPDX-License-Identifier: GPL-3.0-or-later
"""Lights, emissive triangles, the light tree and light links, as shaders read them."""

import enum

from ...gl.buffers.constants import Constants
from ...gl.buffers.records import Record
from ...gl.buffers.storage_blocks import StorageBlock

NO_LIGHT_GROUP = 0xFFFFFFFF
"""In place of the number of a light group."""
Constants("LightGroups", NO_LIGHT_GROUP=NO_LIGHT_GROUP)
StorageBlock("LightGroupTable", "uint light_group_table[];")
"""Numbers of the light groups of the lights, then of the instances."""


class LightShape(enum.IntEnum):
    """Kinds of lights on the device: the emissive meshes are one, and so is the world. Nothing but photons comes from
    media: rays find what these emit along their way."""

    POINT = 0
    SPOT = 1
    SUN = 2
    RECTANGLE = 3
    ELLIPSE = 4
    MESH = 5
    WORLD = 6
    MEDIUM = 7


class EmitterTrait(enum.IntFlag):
    """Traits of an emissive triangle."""

    UNEVEN = 1
    """The emission varies with place or direction."""
    REFLECTED = 2
    """Smooth surfaces look for it: it is seen by reflection as by shadow rays, and hides what is behind it."""
    HIDDEN_FROM_MEDIA = 4
    """Media scatter none of its light, before something else has."""


EMITTER_LINK_SHIFT = 8
Constants("EmitterTraits", EMITTER=EmitterTrait, EMITTER_LINK_SHIFT=EMITTER_LINK_SHIFT)


class LightFlag(enum.IntFlag):
    """Flags of a light, above the bits of RayVisibility."""

    SOFT = 64
    """The light is a disk that faces each point that it lights."""
    SHADOWLESS = 128
    """No shadows are cast in its light."""
    THROUGH_PORTALS = 256
    """The light is that of the world's photons which leave through portals. It is chosen for nothing else."""
    HOLDS_SURFACES = 512
    """Surfaces lie within the light's radius. A sphere lights them from within, and they hide parts of a disk."""
    HOLDS_MEDIUM = 1024
    """The light is a sphere, with a medium within it that it lights from within."""


Constants("Lights", LIGHT=LightShape)
Constants("LightFlags", LIGHT=LightFlag)
LIGHT = Record(
    "Light",
    position="vec3",
    kind="uint",
    axis_u="vec3",
    radius="float",
    axis_v="vec3",
    area="float",
    normal="vec3",
    selection_probability="float",
    strength="vec3",
    selection_end="float",
    cosine_cone="float",
    blend="float",
    spread_tangent="float",
    spread_scale="float",
    first_photon="uint",
    photon_count="uint",
    flags="uint",
    first_cell="uint",
    cells="uvec4",
    falloff="float",
    smoothing="float",
    map_shape="uint",
    map_extent="float",
    map="vec4",
    link="uint",
    max_bounces="uint",
    emissive_medium="uint",
)
"""A light as integrator/lights/light_entry.py lays it out: ``axis_u`` and ``axis_v`` are half extents (AREA) or
unit axes, ``falloff`` and ``smoothing`` how Light Falloff nodes change it with the distance,
``selection_end`` the cumulated probability of choosing this or an earlier light, ``cells`` and
``first_cell`` those of lights/guide.py; ``map`` where its map lies among the lights' maps, left, bottom, width
and height from 0 to 1, ``map_shape`` what the map is of (materials/evaluation.py), 0 without one, and
``map_extent`` the tangent of half of what a cone's map shows, ``link`` its LightLink,
``max_bounces`` PhotonOrigin's. Of a medium, which is the number ``emissive_medium`` of the EmissiveMedia, ``position``,
``axis_u``, ``axis_v`` and ``normal`` are its EmissiveMedium.frame, and ``strength`` is that of the same."""
EMISSIVE_TRIANGLE = Record(
    "EmissiveTriangle",
    radiance="vec3",
    triangle="uint",
    area="float",
    cumulated="float",
    probability="float",
    traits="uint",
)
"""A world triangle that emits: its radiance, or its mean where the material has it vary; its area; the probability of
choosing it, and that of choosing it or one before; its EmitterTraits, and from bit EMITTER_LINK_SHIFT on its
LightLink. The meshes of instances that rays place in the world have a record for each triangle: ``triangle`` is its
leaf, the area is that in object space, and the probability that within the mesh."""
StorageBlock("EmissiveTriangles", "EmissiveTriangle emissive_triangles[];")
LIGHT_NODE = Record(
    "LightNode",
    low="vec3",
    intensity="float",
    high="vec3",
    cosine_normals="float",
    axis="vec3",
    cosine_emission="float",
    member="uint",
    two_sided="uint",
    light_sets="uvec2",
)
"""Lights below a node of the light tree: their box, meters; the sum of their intensities, W/sr, of a sun its
irradiance, W/m^2; the cone of the directions that they face (of a sun its disk); how far from those they shine; of a
leaf the number of its light or emissive triangle, or that of an instance (emitters/instances.py); and the bits of the
light sets that any of them shines on."""
LIGHT_LINK = Record("LightLink", light_sets="uvec2", shadow_sets="uvec2")
"""Bits of the sets of objects that lights shine on and that cast shadows in their light (scene/light_linking.py)."""
StorageBlock("LightLinks", "LightLink light_links[];")
