# SPDX-License-Identifier: GPL-3.0-or-later
"""Records that stages hand to each other. Lengths in meters, flux in W, radiance in W/(m^2 sr)."""

import enum

from ...gl.constants import Constants
from ...gl.programs import GROUP_SIZE
from ...gl.records import Record
from ...gl.storage_blocks import StorageBlock
from ...scene.camera import PanoramaKind
from ...scene.meshes import RayVisibility

NO_TRIANGLE = 0xFFFFFFFF
INFINITY_DISTANCE = 1e30
"""Meters, of rays that may go on for ever."""
Constants("Distances", NO_TRIANGLE=NO_TRIANGLE, INFINITY_DISTANCE=INFINITY_DISTANCE)
Constants("RayVisibility", RAY=RayVisibility)


@enum.unique
class RandomStage(enum.IntEnum):
    """What random numbers are for: those of one stage have nothing to do with those of another."""

    EMISSION = 1
    PHOTONS = 2
    IMPORTONS = 3
    DIRECT_LIGHT = 4
    RESOLVE = 5
    SPLATTING = 6
    GATHERING = 7
    CAMERA = 8
    SHADOW_CATCHER = 9
    WAVELENGTH = 10
    SUBSURFACE = 11
    SUBSURFACE_PHOTONS = 12
    NODE_RAYS = 13
    COVERAGE = 14


Constants("RandomStages", STAGE=RandomStage)

RAY = Record("Ray", origin="vec3", source_triangle="uint", direction="vec3", maximum_distance="float")
"""A ray to be traced; maximum_distance <= 0 marks it inactive, source_triangle is never hit."""
StorageBlock("Rays", "Ray rays[];")
StorageBlock("ShadowRays", "Ray shadow_rays[];")

HIT = Record("Hit", triangle="uint", b1="float", b2="float", distance="float")
"""What any kind of visibility yields; triangle NO_TRIANGLE is a miss.
The point is (1 - b1 - b2) v0 + b1 v1 + b2 v2."""
StorageBlock("Hits", "Hit hits[];")
StorageBlock("HitOrder", "uint hit_order[];")
"""Numbers of hits by the program that evaluates their material (shaders/resolve/ranges.glsl)."""
StorageBlock("Visibility", "uint visibility[];")
"""Of shadow rays: 1 where nothing is in the way."""

LIVING_PATHS_HEADER = Record(
    "LivingPathsHeader",
    first="uint",
    count="uint",
    unused0="uint",
    unused1="uint",
    groups="uvec3",
    unused2="uint",
)
"""How a list of paths begins (living_paths.py): their ``count``, and the ``groups`` of a dispatch over them. It is laid
out as a range of shaders/resolve/ranges.glsl, ``first`` being the word where the numbers begin: a list stands for the
order of the hits where one program resolves them all."""
StorageBlock("KeptPaths", "LivingPathsHeader kept; uint kept_paths[];")

TRIANGLE_ATTRIBUTES = Record(
    "TriangleAttributes",
    normal0="uint",
    normal1="uint",
    normal2="uint",
    material="uint",
    uv0="vec2",
    uv1="vec2",
    uv2="vec2",
    instance="uint",
    unused="uint",
)
"""Shading normals (octahedral, two 16-bit parts), UV, material and instance of a world triangle."""
StorageBlock("Attributes", "TriangleAttributes attributes[];")
TRIANGLE_VERTICES = Record("TriangleVertices", vertex0="vec4", vertex1="vec4", vertex2="vec4")
StorageBlock("Triangles", "vec4 triangle_vertices[];")
"""Three a triangle; for the fourth components see shaders/geometry/gather.comp."""

MICROFACET_LOBE = Record(
    "MicrofacetLobe",
    weight="vec3",
    kind="uint",
    f0="vec3",
    alpha="float",
    tint="vec3",
    ior="float",
    normal="uint",
    anisotropy="uint",
)
"""A GGX, sheen, toon or hair lobe as seen from the side of the arriving path. ``ior`` is the index behind the surface
over the index before it; f0 is the reflectance at normal incidence, or GLASS: the tint of what passes
(weight is then the tint of what is reflected), or SHEEN: the two coefficients of its transformation.
``alpha`` is the geometric mean of both axes', ``anisotropy`` their direction and ratio
(common/bsdf/ggx.glsl), ``normal`` octahedral. What they are of hair says common/bsdf/hair.glsl."""


class MicrofacetKind(enum.IntEnum):
    """What a lobe is."""

    NONE = 0
    MIRROR = 1
    """Reflects all; a black tint stands for the model of Ashikhmin and Shirley, which programs know where
    ASHIKHMIN_LOBES is defined."""
    METAL = 2
    """Schlick's Fresnel from f0 to white; tint is of the edge at 82 degrees."""
    DIELECTRIC = 3
    """Reflection of a dielectric, f0 tinted."""
    GLASS = 4
    """Reflects and refracts; tint is of the reflectance at normal incidence."""
    REFRACTION = 5
    """Refracts only, without Fresnel's loss."""
    COATED_GLASS = 6
    """Glass whose reflectance at normal incidence is the tint."""
    SHEET = 7
    """Passes all through a sheet without thickness: a mirror's light, on the other side."""
    SHEEN = 8
    """f0.xy are the coefficients of sheen_pdf."""
    VELVET = 9
    """f0.x is sigma."""
    TOON = 10
    """f0 is the shape of a cone about the normal (common/bsdf/toon.glsl)."""
    GLOSSY_TOON = 11
    """About the mirrored direction."""
    HAIR_REFLECTION = 12
    """Of fibers, as those that follow: programs know them where HAIR_LOBES is defined."""
    HAIR_TRANSMISSION = 13
    HAIR_CHIANG = 14
    HAIR_HUANG = 15


Constants("MicrofacetKinds", LOBE=MicrofacetKind)
Constants("HairLobes", HAIR_ON_STRAND=1)
"""In ``anisotropy`` of principled hair: the lowest bit, which is no part of an angle."""

CLOSURE_LOBE = Record(
    "ClosureLobe",
    weight="vec3",
    kind="uint",
    f0="vec3",
    alpha="float",
    ior="float",
    normal="uint",
    anisotropy="uint",
)
"""A MicrofacetLobe as closures keep it: the kind comes with the tint."""
CLOSURE_LOBES = 3
Constants("ClosureLobes", signed=True, CLOSURE_LOBES=CLOSURE_LOBES)
CLOSURE = Record(
    "Closure",
    position="vec3",
    triangle="uint",
    diffuse="vec3",
    flags="uint",
    emission="vec3",
    geometric_normal="uint",
    transparent="vec3",
    shading_normal="uint",
    translucent="vec3",
    diffuse_normal="uint",
    distance="float",
    material="uint",
    diffuse_roughness="uint",
    ray_offset="float",
    lobes=(CLOSURE_LOBE, CLOSURE_LOBES),
)
"""All that scattering, storing and estimating need to know about a hit. Normals face the arriving
path; bit 0 of ``flags`` tells that it came from behind, the upper half is the holdout. The diffuse roughness comes with
the albedo that its interreflection takes (common/bsdf/diffuse.glsl). ``ray_offset``: how far along the geometric normal
rays begin, meters (common/geometry.glsl)."""
StorageBlock("Closures", "Closure closures[];")
StorageBlock("ExitClosures", "Closure exit_closures[];")
"""Where camera paths that went below a surface have come out of it, and else what they have met."""

SUBSURFACE_WALK = Record(
    "SubsurfaceWalk",
    throughput="vec3",
    instance="uint",
    entry="vec3",
    opposite="float",
    extinction="vec3",
    anisotropy="float",
    albedo="vec3",
    normal="uint",
)
"""A random walk below a surface of an instance: where it went in, the ``normal`` there (packed), and how far behind
that the surface is met again, meters, less than 0 where it is not near; ``extinction``, 1/m, and ``albedo`` are those
of single scattering."""
StorageBlock("SubsurfaceWalks", "SubsurfaceWalk subsurface_walks[];")
StorageBlock("WalkRays", "Ray walk_rays[];")
StorageBlock("ExitHits", "Hit exit_hits[];")
"""Where walks have come out; none of those that have not."""

TERMINATOR_SHIFT, TERMINATOR_STEPS = 10, 63
"""Where in a closure's flags, and in how many steps, the shading offset of the shadow terminator stands."""
Constants(
    "Terminators",
    TERMINATOR_SHIFT=TERMINATOR_SHIFT,
    TERMINATOR_STEPS=TERMINATOR_STEPS,
)

PHOTON_PATH = Record("PhotonPath", flux="vec3", flags="uint", depth="uint", escaped="float", deposited="float")
"""Flux that a photon path carries along its current ray, zero once the path has ended, and its flags
(PhotonFlag) with the volumes it is in (materials/medium.glsl); its ``depth`` (Depths); and of its flux, W summed over
the channels, what left the scene and what it still carried to the vertex at which a limit cut it off."""
StorageBlock("PhotonPaths", "PhotonPath photon_paths[];")
PHOTON_ORIGIN = Record("PhotonOrigin", radiance="float", pdf="float", max_bounces="uint")
"""The world where a photon comes from: its radiance, W/(m^2 sr), the largest channel; the pdf of shadow rays that way
from where no gathering ray stands for them, 1/sr; both 0 for photons of other lights. And the light's ``max_bounces``:
how often what it lights may have scattered on the way to the camera."""
StorageBlock("PhotonOrigins", "PhotonOrigin photon_origins[];")

PHOTON_DIFFERENTIAL = Record(
    "PhotonDifferential",
    place_u="vec3",
    known="uint",
    turn_u="vec3",
    blur="float",
    place_v="vec3",
    spread="float",
    turn_v="vec3",
    before="float",
)
"""How far from a photon's ray its neighbors' run, along two directions: ``place`` in meters at the ray's origin,
``turn`` by how much their directions differ. ``blur`` is the radius, meters, over which the light's own size spreads
what comes there, before the first hit the light's, and ``spread`` by how much it grows with the distance; ``before`` is
how far the ray's origin is from the light, INFINITY_DISTANCE from those without a place, or behind the first hit from
the surface that turned the photon last. ``known`` is 0 where neighbors are not followed any more."""
StorageBlock("PhotonDifferentials", "PhotonDifferential photon_differentials[];")

ADJOINT_QUERY = Record(
    "AdjointQuery", share="vec3", part="uint", ior="float", flags="uint", reach="float", unused="uint"
)
"""How a photon goes on from a surface whose scattering depends on where it is seen from: by which ``part`` of the
closure (shaders/photons/parts.glsl), the ``share`` that this scatters as seen from where the photon came from, and
the ``ior`` of a sharp refraction. ``flags`` are those of its path from here on, and its ray ends at
``reach``, meters. A share of 0 is not compared."""
StorageBlock("AdjointQueries", "AdjointQuery adjoint_queries[];")

PHOTON = Record(
    "Photon",
    position="vec3",
    flags="uint",
    flux="vec3",
    geometric_normal="uint",
    direction="vec3",
    distance="float",
    path="uint",
    depth="uint",
    unused0="uint",
    unused1="uint",
)
"""One light path vertex, 64 bytes (paper section 5.1). Those of a segment follow each other as its living paths do.
``direction`` points back to where the photon came from, which is ``distance`` meters away, straight through what is
transparent. The upper bits of ``flags`` are those of the radius of its footprint, meters, 0 where that is not known.
``path`` is the number of its path, with that of the segment above (PhotonNumbers); ``depth`` that of the path (Depths),
with PHOTON_CONTRIBUTED once an importon takes it."""
PHOTON_SEGMENT_SHIFT = 22
"""Photons of an iteration are fewer (MOST_PHOTONS), and segments than what is left of a word (MOST_SEGMENTS)."""
PHOTON_CONTRIBUTED = 1 << 31
Constants("PhotonNumbers", PHOTON_SEGMENT_SHIFT=PHOTON_SEGMENT_SHIFT, PHOTON_CONTRIBUTED=PHOTON_CONTRIBUTED)
DEPTH_BITS = 11
"""Bits of the number of bounces in a depth, and of that of transparent surfaces above it."""
Constants("Depths", DEPTH_BITS=DEPTH_BITS)
StorageBlock("PhotonRange", "uint photon_first; uint photon_end;")
"""Where the photons of the current segment begin among those of the iteration, and where they end."""
StorageBlock("Photons", "Photon photons[];")
StorageBlock("StoredPhotons", "uint stored_count; uint diffused_count; uint indirect_count; uint stored_photons[];")
"""How many are stored, how many of these are diffused, and the numbers of the stored ones."""

FLUX_GROUP = GROUP_SIZE
"""Paths whose fluxes the device sums (shaders/photons/balance.comp)."""
FLUX_NAMES = ("emitted", "absorbed", "deposited", "escaped", "lost")
FLUX_SUMS = Record("FluxSums", **dict.fromkeys((*FLUX_NAMES, "unused0", "unused1", "unused2"), "float"))


class PhotonFlag(enum.IntFlag):
    """Flags of photons and of their paths, which have the low ten bits (materials/medium.glsl)."""

    ACTIVE = 1
    STORED = 2
    ESCAPED = 4
    AFTER_ROUGH_BOUNCE = 8
    """A diffuse or rough surface has scattered the path before."""
    INDIRECT = 16
    """What stores photons has scattered it."""
    DIRECT = 32
    """Nothing has scattered it, but for objects that cast no shadow."""
    NOT_DIFFUSE = 64
    """While it is direct: from a light that diffuse events do not see."""
    NOT_GLOSSY = 128
    NOT_TRANSMITTED = 256
    CASTS_SHADOWS = 512
    """Nothing but transparency lies between it and its light, which is not the world."""


class PhotonHistory(enum.IntFlag):
    """Further flags, in a photon where its path has NOT_GLOSSY and NOT_TRANSMITTED, which nobody asks photons for; in a
    path so many bits lower, where a photon has ACTIVE and STORED."""

    SCATTERED_BY_LOBE = 128
    """What scattered it last was a lobe that is not diffuse."""
    CAUSTIC = 256
    """A diffuse surface has scattered what had come by such a lobe."""


Constants("PhotonFlags", PHOTON=PhotonFlag)
Constants("PhotonHistory", PHOTON=PhotonHistory, PHOTON_HISTORY_SHIFT=7)
PHOTON_FLAG_BITS = 10
"""Of a photon's word; the others are a float's."""
Constants("PhotonFootprints", PHOTON_FLAG_MASK=(1 << PHOTON_FLAG_BITS) - 1)
Constants("Dispersion", PATH_DISPERSED=1 << PHOTON_FLAG_BITS)
"""A flag of the camera's and the photons' paths alike, above their own: their light has but one wavelength."""


class Scatter(enum.IntEnum):
    """What Cycles tells apart of how a surface scatters, in the order of the passes of it (scene/passes.py)."""

    NONE = 0
    DIFFUSE = 1
    GLOSSY = 2
    TRANSMISSION = 3


class PathHistory(enum.IntFlag):
    """What passes of light ask for of a camera path, above the Scatter of its first surface that is not transparent."""

    AGAIN = 4
    """More than one has scattered it."""
    DIFFUSE = 8
    """The last that did was diffuse."""
    CAUSTIC = 16
    """One that was not diffuse has scattered it after one that was: Cycles ends it there where Caustics are off."""


Constants("PathHistory", SCATTER=Scatter, HISTORY=PathHistory)

CAMERA_PATH = Record(
    "CameraPath",
    throughput="vec3",
    scatter_pdf="float",
    total_length="float",
    straight_length="float",
    primary_radius="float",
    flags="uint",
    depth="uint",
    lit_normal="uint",
    lit_from="uint",
)
"""A camera path between two segments: ``total_length`` is the sum of the segments in Eq. 4, with the way to
the clip start, ``straight_length`` of those that led straight through surfaces since the last event of another kind,
``primary_radius`` the radius of a pixel's cone at distance 1, or of its beam of parallel rays, from the primary hit on
that of the disk of Eq. 3 in iteration 1, likewise at distance 1, ``scatter_pdf`` that of the scattered direction in
1/sr where shadow rays sample the same light, else 0; ``depth`` counts bounces and transparent surfaces (Depths);
``lit_normal`` and ``lit_from`` tell how these shadow rays chose their light (shaders/importons/scatter_point.glsl)."""
StorageBlock("CameraPaths", "CameraPath camera_paths[];")
StorageBlock("Radiances", "vec4 radiances[];")
"""Of the pixels of a band, W/(m^2 sr), and alpha."""
StorageBlock("RadiusFactors", "float radius_factors[];")
StorageBlock("PassCounts", "uvec2 pass_counts[];")
StorageBlock("LitCatchers", "uint lit_catchers[];")
StorageBlock("AovValues", "float aov_values[];")
"""Of the paths of a band, what AOV Output nodes have written."""
StorageBlock("Contributions", "vec4 contributions[];")
StorageBlock("LightTriangles", "uint light_triangles[];")
"""What shadow rays add where nothing is in their way, with a signed code (shaders/common/light_sets.glsl) of whether a
gathering ray found it and of the light's LightLink; and the emissive triangles that they go to."""

LIGHT_SPLIT = Record("LightSplit", glossy="vec3", light="uint", transmission="vec3", unused="float")
"""Of what a shadow ray adds, by channel: the parts that such lobes scatter; the rest is diffuse. ``light`` is the
number of the light that it goes to, if that is no triangle."""
StorageBlock("LightSplits", "LightSplit light_splits[];")

NO_LIGHT_GROUP = 0xFFFFFFFF
"""In place of the number of a light group."""
Constants("LightGroups", NO_LIGHT_GROUP=NO_LIGHT_GROUP)
StorageBlock("LightGroupTable", "uint light_group_table[];")
"""Numbers of the light groups of the lights, then of the instances."""
StorageBlock("PhotonGroups", "uint photon_groups[];")
"""Of the photons that left the lights, the numbers of their light groups."""

IMPORTON = Record(
    "Importon",
    position="vec3",
    radius="float",
    direction="vec3",
    geometric_normal="uint",
    diffuse="vec3",
    diffuse_normal="uint",
    translucent="vec3",
    diffuse_roughness="uint",
    lobe_weight="vec3",
    lobe_kind="uint",
    lobe_f0="vec3",
    lobe_alpha="float",
    lobe_ior="float",
    lobe_normal="uint",
    lobe_anisotropy="uint",
    next="uint",
    gathers="uint",
    shading_normal="uint",
    least_radius="float",
    history="uint",
)
"""A camera path vertex where radiance is estimated; radius 0 marks none. Photons that know their footprint count within
a radius of their own between ``least_radius`` and ``radius``. The weights already hold
the path's throughput, diffuse and translucent also 1 / pi. ``direction`` points back to the viewer;
``next`` links lists of the splat cubemap; ``gathers`` is a GatherFlag. ``history`` is the
PathHistory of the path as it came, and above as it goes on, which stays when it ends; in the upper bits its depth
(Depths) as it came."""
StorageBlock("Importons", "Importon importons[];")


class GatherFlag(enum.IntFlag):
    """What importons gather; without the first they take all photons."""

    GATHERS_BY_RAY = 1
    """It leaves indirect photons to the path, which goes on for them."""
    GATHERED_BY_RAY = 2
    """It stands where that led, and counts for the vertex that the path set out from."""


PHOTON_FACTOR_SHIFT = 8
"""Above the flags, what diffused photons are multiplied by; 0 is 1."""
Constants("PhotonFactor", PHOTON_FACTOR_SHIFT=PHOTON_FACTOR_SHIFT)
Constants("GatherFlags", GATHERS_BY_RAY=GatherFlag.GATHERS_BY_RAY, GATHERED_BY_RAY=GatherFlag.GATHERED_BY_RAY)

GATHERING_VERTEX = Record(
    "GatheringVertex",
    position="vec3",
    shared_radius="float",
    weight="vec3",
    normal="uint",
    found="vec3",
    radius="float",
    hit="vec3",
    hit_normal="uint",
)
"""Where a camera path set out to gather, with its BSDF and throughput over the ray's density, sr. ``radius`` is
the importon's, meters, and so is ``shared_radius``, but for 0 where what the ray finds is not shared; less than 0
marks none. ``normal`` is on the side that the ray went to, ``found`` the radiance of the world that the ray came to by
sharp surfaces, but for the photons' share, at once, if the world is even, or from a second such vertex, of which
``radius`` then is. ``hit`` is where the ray arrived at a surface that stores photons, ``hit_normal`` on its side; where
it came to none, far behind all. Before the path gathers, ``position`` is where it was scattered last."""
StorageBlock("GatheringVertices", "GatheringVertex gathering_vertices[];")
StorageBlock("FoundRadiances", "vec4 found_radiances[];")


class LightShape(enum.IntEnum):
    """Kinds of lights on the device: the emissive meshes are one, and so is the world."""

    POINT = 0
    SPOT = 1
    SUN = 2
    RECTANGLE = 3
    ELLIPSE = 4
    MESH = 5
    WORLD = 6


class EmitterTrait(enum.IntFlag):
    """Of an emissive triangle."""

    UNEVEN = 1
    """What it emits varies with place or direction."""
    REFLECTED = 2
    """Smooth surfaces look for it: it is seen by reflection as by shadow rays, and hides what is behind it."""


EMITTER_LINK_SHIFT = 8
Constants("EmitterTraits", EMITTER=EmitterTrait, EMITTER_LINK_SHIFT=EMITTER_LINK_SHIFT)

LIGHT_SOFT = 32
"""Of a light's flags, behind the bits of RayVisibility: a disk that faces each point it lights."""
LIGHT_SHADOWLESS = 64
"""Likewise: no shadows are cast in its light."""
LIGHT_THROUGH_PORTALS = 128
"""Likewise: photons of the world that leave through portals. It is chosen for nothing else."""
LIGHT_HOLDS_SURFACES = 256
"""Likewise: there are surfaces within its radius, which a sphere lights from within and which hide parts of a disk."""
Constants(
    "Lights",
    LIGHT=LightShape,
    LIGHT_SOFT=LIGHT_SOFT,
    LIGHT_SHADOWLESS=LIGHT_SHADOWLESS,
    LIGHT_THROUGH_PORTALS=LIGHT_THROUGH_PORTALS,
    LIGHT_HOLDS_SURFACES=LIGHT_HOLDS_SURFACES,
)

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
)
"""A light as integrator/lights/light_entry.py lays it out: ``axis_u`` and ``axis_v`` are half extents (AREA) or
unit axes, ``falloff`` and ``smoothing`` how Light Falloff nodes change it with the distance,
``selection_end`` the cumulated probability of choosing this or an earlier light, ``cells`` and
``first_cell`` those of lights/guide.py; ``map`` where its map lies among the lights' maps, left, bottom, width
and height from 0 to 1, ``map_shape`` what the map is of (materials/evaluation.py), 0 without one, and
``map_extent`` the tangent of half of what a cone's map shows, ``link`` its LightLink,
``max_bounces`` PhotonOrigin's."""

EMISSIVE_TRIANGLE = Record(
    "EmissiveTriangle",
    radiance="vec3",
    triangle="uint",
    area="float",
    cumulated="float",
    share="float",
    traits="uint",
)
"""A world triangle that emits: its radiance, or its mean where the material has it vary; its area; the probability of
choosing it, and that of choosing it or one before; its EmitterTraits, and from bit EMITTER_LINK_SHIFT on its
LightLink."""
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
leaf the number of its light or emissive triangle; and the bits of the light sets that any of them shines on."""

LIGHT_LINK = Record("LightLink", light_sets="uvec2", shadow_sets="uvec2")
"""Bits of the sets of objects that lights shine on and that cast shadows in their light (scene/light_linking.py)."""
StorageBlock("LightLinks", "LightLink light_links[];")
StorageBlock("PhotonLinks", "uint photon_links[];")
"""Of the photons that left the lights, the numbers of their LightLinks."""

PROJECTIONS = ("PERSPECTIVE", "ORTHOGRAPHIC", *(kind.name for kind in PanoramaKind))
"""Of cameras, by number."""
Constants("Projections", PROJECTION={name: number for number, name in enumerate(PROJECTIONS)})

CAMERA_VIEW = Record(
    "CameraView",
    position="vec3",
    projection="uint",
    right="vec3",
    clip_start="float",
    up="vec3",
    clip_end="float",
    forward="vec3",
    pixel_area="float",
    window="vec4",
    width="uint",
    height="uint",
    aperture_blades="uint",
    aperture_radius="float",
    focus_distance="float",
    aperture_rotation="float",
    aperture_ratio="float",
    field_of_view="float",
    panorama_range="vec4",
    sensor="vec2",
    lens="float",
    polynomial_constant="float",
    polynomial="vec4",
)
"""The band of the frame being rendered: ``window`` is left, right, bottom, top of the band with the
iteration's jitter; ``pixel_area`` is a pixel's area on the window: at distance 1 of perspective
cameras, m^2 of orthographic ones, share of the frame of panoramas. ``aperture_radius`` 0 is a pinhole.
``panorama_range`` is left, right, bottom, top in radians or of a cylinder of radius 1; ``sensor`` and
``lens`` are in millimeters."""
StorageBlock("Camera", "CameraView camera;")
