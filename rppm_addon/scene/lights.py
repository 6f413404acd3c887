# SPDX-License-Identifier: GPL-3.0-or-later
"""Light sources in radiometric quantities; the exporter converts Blender's units to them."""

import enum
from dataclasses import dataclass, field

import numpy as np

from .common.declared import declared
from .light_linking import LightLinking
from .meshes import RayVisibility
from .node_graphs import NodeGraph


class LightKind(enum.Enum):
    """As Blender names the types of lights."""

    POINT = "point"
    SPOT = "spot"
    SUN = "sun"
    AREA = "area"


UNLIMITED_BOUNCES = 1024
"""Value of ``max_bounces`` that means no limit, as Blender has it."""


@dataclass
class Light:
    """A light object. It shines along its local -Z axis, as Blender's lights do."""

    name: str
    kind: LightKind
    matrix: np.ndarray = field(metadata=declared(4, 4, finite=False))
    """(4, 4) float64, object to world; includes the object's scale."""
    strength: np.ndarray = field(metadata=declared(3))
    """(3,) float64 linear Rec.709: POINT and SPOT radiant intensity on the axis W/sr;
    SUN irradiance on a facing surface W/m^2; AREA radiance W/(m^2 sr)."""
    radius: float = field(default=0.0, metadata=declared(minimum=0.0))
    """POINT and SPOT: radius of the emitting sphere, meters."""
    soft_falloff: bool = False
    """POINT and SPOT: a disk that faces each point it lights in place of the sphere, which keeps
    surfaces near a large light from glaring (Blender's Soft Falloff)."""
    spot_angle: float = np.pi
    """SPOT: full angle of the cone, radians."""
    spot_blend: float = field(default=0.0, metadata=declared(minimum=0.0, maximum=1.0))
    """SPOT: softness of the cone's edge, 0 to 1 (Cycles' spot smooth)."""
    sun_angle: float = 0.0
    """SUN: full angle under which the disk is seen, radians."""
    shape: str = field(default="SQUARE", metadata=declared(choices=("SQUARE", "RECTANGLE", "DISK", "ELLIPSE")))
    """AREA: SQUARE, RECTANGLE, DISK or ELLIPSE."""
    size: tuple[float, float] = (1.0, 1.0)
    """AREA: full width along local X and height along local Y before the matrix's scale."""
    spread: float = np.pi
    """AREA: full angle of emission, radians (Cycles' spread); pi is diffuse."""
    is_portal: bool = False
    """AREA: it gives no light, but says where the world's comes in, to the side that it faces."""
    visibility: RayVisibility = RayVisibility.ALL
    """Kinds of rays that see the light itself or are lit by it: camera, diffuse, glossy and transmission rays."""
    graph: NodeGraph | None = None
    """Its emission multiplies ``strength``; None is 1."""
    of_world: bool = False
    """SUN: whether the graph is a world's, which the sun belongs to, and sees directions as a world does."""
    photon_weight: float = field(default=1.0, metadata=declared(minimum=0.0))
    """Weight of this light when photons are allocated (paper section 4.3), on top of its power."""
    light_group: str = ""
    """Whose pass its light belongs to (RenderSettings.light_groups); "" is none."""
    linking: LightLinking | None = None
    """None: it shines on all objects, and all cast shadows."""
    casts_shadow: bool = True
    """Whether objects cast shadows in its light at all; without, it passes through them straight from the light."""
    max_bounces: int = field(default=UNLIMITED_BOUNCES, metadata=declared(minimum=0, maximum=UNLIMITED_BOUNCES))
    """How often its light is scattered beyond the surface that it falls on; 0 is direct light alone."""


@dataclass
class Mist:
    """Range of the pass Mist: 0 up to ``start``, 1 from ``start`` + ``depth`` on, meters."""

    start: float = 0.0
    depth: float = 100.0
    exponent: float = 1.0
    """Exponent of the fraction of the way between."""


@dataclass
class World:
    """The environment: constant radiance, or what a node graph gives by direction."""

    radiance: np.ndarray = field(default_factory=lambda: np.zeros(3), metadata=declared(3))
    """(3,) float64 W/(m^2 sr); multiplies what the graph gives where there is one."""
    graph: NodeGraph | None = None
    volume: NodeGraph | None = None
    """Nodes of the medium that fills the world, as Material.interior."""
    mist: Mist = field(default_factory=Mist)
    ambient_occlusion_distance: float = field(default=10.0, metadata=declared(minimum=0.0))
    """Length of the rays of the pass Ambient Occlusion, meters."""
    light_group: str = ""
    """As of a light."""
    visibility: RayVisibility = RayVisibility.ALL
    """Kinds of rays that see the world or are lit by it, as of a light."""
    max_bounces: int = field(default=UNLIMITED_BOUNCES, metadata=declared(minimum=0, maximum=UNLIMITED_BOUNCES))
    """As of a light, where the world is not even; the light of one that is has no limit, as in Cycles."""
