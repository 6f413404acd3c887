# SPDX-License-Identifier: GPL-3.0-or-later
"""Procedural textures, whose values are those of Cycles 5.0."""

from ...gl.buffers.constants import Constants
from .node_kinds import BOOLEAN, COLOR, FLOAT, VECTOR, NodeKind

ORIGIN = (0.0, 0.0, 0.0)
DIMENSIONS = ("1D", "2D", "3D", "4D")
_NOISE_TYPES = ("MULTIFRACTAL", "RIDGED_MULTIFRACTAL", "HYBRID_MULTIFRACTAL", "FBM", "HETERO_TERRAIN")
_VORONOI_FEATURES = ("F1", "F2", "SMOOTH_F1", "DISTANCE_TO_EDGE", "N_SPHERE_RADIUS")
_VORONOI_METRICS = ("EUCLIDEAN", "MANHATTAN", "CHEBYCHEV", "MINKOWSKI")
_WAVE_TYPES, _WAVE_PROFILES = ("BANDS", "RINGS"), ("SIN", "SAW", "TRI")
_BANDS_DIRECTIONS, _RINGS_DIRECTIONS = ("X", "Y", "Z", "DIAGONAL"), ("X", "Y", "Z", "SPHERICAL")
_GRADIENT_TYPES = ("LINEAR", "QUADRATIC", "EASING", "DIAGONAL", "SPHERICAL", "QUADRATIC_SPHERE", "RADIAL")
Constants("NoiseTypes", NOISE=_NOISE_TYPES)
Constants("VoronoiFeatures", VORONOI=_VORONOI_FEATURES)
Constants("VoronoiMetrics", VORONOI=_VORONOI_METRICS)
Constants("WaveOptions", WAVE=_WAVE_TYPES, PROFILE=_WAVE_PROFILES, BANDS=_BANDS_DIRECTIONS, RINGS=_RINGS_DIRECTIONS)
Constants("GradientTypes", GRADIENT=_GRADIENT_TYPES)

_NOISE = NodeKind(
    "noise.glsl",
    inputs={
        "vector": (VECTOR, ORIGIN),
        "w": (FLOAT, 0.0),
        "scale": (FLOAT, 5.0),
        "detail": (FLOAT, 2.0),
        "roughness": (FLOAT, 0.5),
        "lacunarity": (FLOAT, 2.0),
        "offset": (FLOAT, 0.0),
        "gain": (FLOAT, 1.0),
        "distortion": (FLOAT, 0.0),
    },
    outputs={"fac": FLOAT, "color": COLOR},
    options={
        "noise_dimensions": DIMENSIONS,
        "noise_type": _NOISE_TYPES,
        "normalize": BOOLEAN,
    },
)
_VORONOI = NodeKind(
    "voronoi.glsl",
    inputs={
        "vector": (VECTOR, ORIGIN),
        "w": (FLOAT, 0.0),
        "scale": (FLOAT, 5.0),
        "detail": (FLOAT, 0.0),
        "roughness": (FLOAT, 0.5),
        "lacunarity": (FLOAT, 2.0),
        "smoothness": (FLOAT, 1.0),
        "exponent": (FLOAT, 0.5),
        "randomness": (FLOAT, 1.0),
    },
    outputs={"distance": FLOAT, "color": COLOR, "position": VECTOR, "w": FLOAT, "radius": FLOAT},
    options={
        "voronoi_dimensions": DIMENSIONS,
        "distance": _VORONOI_METRICS,
        "feature": _VORONOI_FEATURES,
        "normalize": BOOLEAN,
    },
)
_WAVE = NodeKind(
    "wave.glsl",
    inputs={
        "vector": (VECTOR, ORIGIN),
        "scale": (FLOAT, 5.0),
        "distortion": (FLOAT, 0.0),
        "detail": (FLOAT, 2.0),
        "detail_scale": (FLOAT, 1.0),
        "detail_roughness": (FLOAT, 0.5),
        "phase_offset": (FLOAT, 0.0),
    },
    outputs={"color": COLOR, "fac": FLOAT},
    options={
        "wave_type": _WAVE_TYPES,
        "bands_direction": _BANDS_DIRECTIONS,
        "rings_direction": _RINGS_DIRECTIONS,
        "wave_profile": _WAVE_PROFILES,
    },
)
_BRICK = NodeKind(
    "brick.glsl",
    # The last four are properties of Blender's node that select no code.
    inputs={
        "vector": (VECTOR, ORIGIN),
        "color1": (COLOR, (0.8, 0.8, 0.8)),
        "color2": (COLOR, (0.2, 0.2, 0.2)),
        "mortar": (COLOR, (0.0, 0.0, 0.0)),
        "scale": (FLOAT, 5.0),
        "mortar_size": (FLOAT, 0.02),
        "mortar_smooth": (FLOAT, 0.1),
        "bias": (FLOAT, 0.0),
        "brick_width": (FLOAT, 0.5),
        "row_height": (FLOAT, 0.25),
        "offset": (FLOAT, 0.5),
        "offset_frequency": (FLOAT, 2.0),
        "squash": (FLOAT, 1.0),
        "squash_frequency": (FLOAT, 2.0),
    },
    outputs={"color": COLOR, "fac": FLOAT},
)
_GABOR = NodeKind(
    "gabor.glsl",
    inputs={
        "vector": (VECTOR, ORIGIN),
        "scale": (FLOAT, 5.0),
        "frequency": (FLOAT, 2.0),
        "anisotropy": (FLOAT, 1.0),
        "orientation_2d": (FLOAT, 0.7853981852531433),
        "orientation_3d": (VECTOR, (1.4142135381698608, 1.4142135381698608, 0.0)),
    },
    outputs={"value": FLOAT, "phase": FLOAT, "intensity": FLOAT},
    options={"gabor_type": ("2D", "3D")},
)

KINDS = {
    "radial_tiling": NodeKind(
        "radial_tiling.glsl",
        inputs={"vector": (VECTOR, ORIGIN), "sides": (FLOAT, 5.0), "roundness": (FLOAT, 0.0)},
        outputs={
            "segment_coordinates": VECTOR,
            "segment_id": FLOAT,
            "segment_width": FLOAT,
            "segment_rotation": FLOAT,
        },
        options={"normalize": BOOLEAN},
    ),
    "tex_noise": _NOISE,
    "tex_voronoi": _VORONOI,
    "tex_wave": _WAVE,
    "tex_magic": NodeKind(
        "magic.glsl",
        inputs={"vector": (VECTOR, ORIGIN), "scale": (FLOAT, 5.0), "distortion": (FLOAT, 1.0)},
        outputs={"color": COLOR, "fac": FLOAT},
        options={"turbulence_depth": tuple(range(11))},
    ),
    "tex_gradient": NodeKind(
        "gradient.glsl",
        inputs={"vector": (VECTOR, ORIGIN)},
        outputs={"color": COLOR, "fac": FLOAT},
        options={"gradient_type": _GRADIENT_TYPES},
    ),
    "tex_checker": NodeKind(
        "checker.glsl",
        inputs={
            "vector": (VECTOR, ORIGIN),
            "color1": (COLOR, (0.8, 0.8, 0.8)),
            "color2": (COLOR, (0.2, 0.2, 0.2)),
            "scale": (FLOAT, 5.0),
        },
        outputs={"color": COLOR, "fac": FLOAT},
    ),
    "tex_brick": _BRICK,
    "tex_white_noise": NodeKind(
        "white_noise.glsl",
        inputs={"vector": (VECTOR, ORIGIN), "w": (FLOAT, 0.0)},
        outputs={"value": FLOAT, "color": COLOR},
        options={"noise_dimensions": DIMENSIONS},
    ),
    "tex_gabor": _GABOR,
}
"""Procedural textures by name."""
