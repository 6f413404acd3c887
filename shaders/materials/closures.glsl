// SPDX-License-Identifier: GPL-3.0-or-later
// From a material's lobes to a closure, seen from one side: what Cycles' shader nodes set up.

#include <Material>
#include <MaterialLobe>
#include "materials/principled.glsl"
#include "materials/textures.glsl"

layout(std430, binding = 5) readonly buffer Materials { Material materials[]; };
layout(std430, binding = 6) readonly buffer MaterialLobes { MaterialLobe material_lobes[]; };

// The numbers of scene.LobeKind.
const uint KIND_DIFFUSE = 0u, KIND_GLOSSY = 1u, KIND_GLASS = 2u, KIND_REFRACTION = 3u,
           KIND_TRANSPARENT = 4u, KIND_EMISSION = 5u, KIND_PRINCIPLED = 6u, KIND_TRANSLUCENT = 7u, KIND_SHEEN = 8u,
           KIND_HOLDOUT = 9u;

void add_material_lobe(inout ClosureBuilder builder, MaterialLobe lobe, vec2 uv) {
    vec3 color = lobe.color;
    if (lobe.color_image != NO_IMAGE) color *= sample_image(lobe.color_image, uv).rgb;
    vec3 weighted = lobe.weight * color;
    bool multiscatter = lobe.multiscatter != 0u;
    Microfacets at = isotropic_microfacets(builder, builder.shading, lobe.roughness);
    if (lobe.kind == KIND_DIFFUSE) add_diffuse(builder, vec3(lobe.weight), color, lobe.roughness, builder.shading);
    else if (lobe.kind == KIND_GLOSSY) add_mirror(builder, at, lobe.weight, color, multiscatter);
    else if (lobe.kind == KIND_GLASS) add_glass(builder, at, weighted, weighted, vec3(1.0), color, lobe.ior, multiscatter);
    else if (lobe.kind == KIND_REFRACTION) add_refraction(builder, at, weighted, lobe.ior);
    else if (lobe.kind == KIND_TRANSPARENT) builder.closure.transparent += weighted;
    else if (lobe.kind == KIND_EMISSION) builder.closure.emission += weighted;
    else if (lobe.kind == KIND_TRANSLUCENT) add_diffuse_parts(builder, vec3(0.0), weighted, builder.shading, 0u);
    else if (lobe.kind == KIND_SHEEN) add_sheen(builder, weighted, lobe.roughness, builder.shading);
    else if (lobe.kind == KIND_HOLDOUT) add_holdout(builder, lobe.weight);
    else if (lobe.kind == KIND_PRINCIPLED) {
        Principled p = plain_principled(builder);
        p.base_color = color;
        p.metallic = lobe.metallic;
        p.roughness = lobe.roughness;
        p.ior = lobe.ior;
        p.alpha = lobe.alpha;
        p.specular_level = lobe.specular_level;
        p.specular_tint = lobe.specular_tint;
        p.transmission = lobe.transmission;
        p.emission = lobe.emission;
        p.multiscatter = multiscatter;
        add_principled(builder, lobe.weight, p);
    }
}
