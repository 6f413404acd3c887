# SPDX-License-Identifier: GPL-3.0-or-later
"""Shader nodes.

Approximations: a random walk for Christensen-Burley; for the
physical conductor of the metallic node, the F82 curve that meets its own at normal incidence and at 82 degrees.
"""

from .node_kinds import BOOLEAN, COLOR, FLOAT, SHADER, VECTOR, NodeKind


def _shader(
    output: str, inputs: dict | None = None, options: dict | None = None, fallbacks: dict[str, str] | None = None
) -> NodeKind:
    return NodeKind("shaders.glsl", inputs or {}, {output: SHADER}, options or {}, fallbacks=fallbacks or {})


_NORMAL = {"normal": (VECTOR, "normal")}
_TANGENT = {"tangent": (VECTOR, "tangent")}
_ANISOTROPY = {"anisotropy": (FLOAT, 0.0), "rotation": (FLOAT, 0.0)} | _NORMAL | _TANGENT
_FILM = {"thin_film_thickness": (FLOAT, 0.0), "thin_film_ior": (FLOAT, 1.33)}
_GRAY, _WHITE = {"color": (COLOR, 0.8)}, {"color": (COLOR, 1.0)}
ASHIKHMIN_SHIRLEY = "ASHIKHMIN_SHIRLEY"
SUBSURFACE_METHODS = ("RANDOM_WALK", "RANDOM_WALK_SKIN", "RANDOM_WALK_LEGACY", "BURLEY")
"""As in Blender 5.2; what is RANDOM_WALK before that is RANDOM_WALK_LEGACY there."""

KINDS = {
    # Both distribute weights and have no GLSL; their shaders are the inputs "shader" and "shader_001".
    "mix_shader": _shader("shader", {"fac": (FLOAT, 0.5)}),
    "add_shader": _shader("shader"),
    "bsdf_diffuse": _shader("bsdf", _GRAY | {"roughness": (FLOAT, 0.0)} | _NORMAL),
    "bsdf_translucent": _shader("bsdf", _GRAY | _NORMAL),
    "bsdf_transparent": _shader("bsdf", _WHITE),
    "emission": _shader("emission", _WHITE | {"strength": (FLOAT, 1.0)}),
    "background": _shader("background", _GRAY | {"strength": (FLOAT, 1.0)}),
    "holdout": _shader("holdout"),
    "bsdf_glossy": _shader(
        "bsdf",
        _GRAY | {"roughness": (FLOAT, 0.5)} | _ANISOTROPY,
        {"distribution": ("BECKMANN", "GGX", ASHIKHMIN_SHIRLEY, "MULTI_GGX")},
    ),
    "bsdf_glass": _shader(
        "bsdf",
        _WHITE | {"roughness": (FLOAT, 0.0), "ior": (FLOAT, 1.5)} | _NORMAL | _FILM,
        {"distribution": ("BECKMANN", "GGX", "MULTI_GGX")},
    ),
    "bsdf_refraction": _shader(
        "bsdf",
        _WHITE | {"roughness": (FLOAT, 0.0), "ior": (FLOAT, 1.45)} | _NORMAL,
        {"distribution": ("BECKMANN", "GGX")},
    ),
    "bsdf_ray_portal": _shader(
        "bsdf", _WHITE | {"position": (VECTOR, "position"), "direction": (VECTOR, (0.0, 0.0, 0.0))}
    ),
    "bsdf_sheen": _shader(
        "bsdf", _GRAY | {"roughness": (FLOAT, 0.5)} | _NORMAL, {"distribution": ("ASHIKHMIN", "MICROFIBER")}
    ),
    "subsurface_scattering": _shader(
        "bssrdf",
        _GRAY
        | {
            "scale": (FLOAT, 0.05),
            "radius": (VECTOR, (1.0, 0.2, 0.1)),
            "ior": (FLOAT, 1.4),
            "roughness": (FLOAT, 1.0),
            "anisotropy": (FLOAT, 0.0),
        }
        | _NORMAL,
        {"falloff": SUBSURFACE_METHODS},
        {"BURLEY": "a random walk of the same mean free path"},
    ),
    "bsdf_metallic": _shader(
        "bsdf",
        {
            "base_color": (COLOR, (0.617, 0.577, 0.540)),
            "edge_tint": (COLOR, (0.695, 0.726, 0.770)),
            "ior": (VECTOR, (2.757, 2.513, 2.231)),
            "extinction": (VECTOR, (3.867, 3.404, 3.009)),
            "roughness": (FLOAT, 0.5),
        }
        | _ANISOTROPY
        | _FILM,
        {"distribution": ("BECKMANN", "GGX", "MULTI_GGX"), "fresnel_type": ("PHYSICAL_CONDUCTOR", "F82")},
    ),
    "bsdf_toon": _shader(
        "bsdf",
        _GRAY | {"size": (FLOAT, 0.5), "smooth": (FLOAT, 0.0)} | _NORMAL,
        {"component": ("DIFFUSE", "GLOSSY")},
    ),
    "bsdf_principled": _shader(
        "bsdf",
        {
            "base_color": (COLOR, 0.8),
            "metallic": (FLOAT, 0.0),
            "roughness": (FLOAT, 0.5),
            "ior": (FLOAT, 1.5),
            "alpha": (FLOAT, 1.0),
            **_NORMAL,
            "diffuse_roughness": (FLOAT, 0.0),
            "subsurface_weight": (FLOAT, 0.0),
            "subsurface_radius": (VECTOR, (1.0, 0.2, 0.1)),
            "subsurface_scale": (FLOAT, 0.05),
            "subsurface_ior": (FLOAT, 1.4),
            "subsurface_anisotropy": (FLOAT, 0.0),
            "specular_ior_level": (FLOAT, 0.5),
            "specular_tint": (COLOR, 1.0),
            "anisotropic": (FLOAT, 0.0),
            "anisotropic_rotation": (FLOAT, 0.0),
            **_TANGENT,
            "transmission_weight": (FLOAT, 0.0),
            "coat_weight": (FLOAT, 0.0),
            "coat_roughness": (FLOAT, 0.03),
            "coat_ior": (FLOAT, 1.5),
            "coat_tint": (COLOR, 1.0),
            "coat_normal": (VECTOR, "normal"),
            "sheen_weight": (FLOAT, 0.0),
            "sheen_roughness": (FLOAT, 0.5),
            "sheen_tint": (COLOR, 1.0),
            "emission_color": (COLOR, 1.0),
            "emission_strength": (FLOAT, 0.0),
            **_FILM,
        },
        {"distribution": ("GGX", "MULTI_GGX"), "subsurface_method": SUBSURFACE_METHODS, "thin_wall": BOOLEAN},
    ),
}
