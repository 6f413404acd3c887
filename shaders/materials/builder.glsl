// SPDX-License-Identifier: GPL-3.0-or-later
// A closure under construction, seen from one side. Shader nodes add to it.
//
// Who resolves a hit makes one by closure_builder() and fills the members of the closure that say where it is:
// position, triangle, flags, material, distance, geometric_normal, shading_normal. All normals are on the viewer's
// side; so are those that nodes get, unless a normal map turns them away.

#define ADDS_LOBES
#include <CausticKinds>
#include "common/bsdf/closure.glsl"

struct ClosureBuilder {
    Closure closure;
    vec3 viewer;  // unit vector to where the path comes from
    vec3 geometric;
    vec3 shading;  // the normal that shaders have without one of their own
    bool backfacing;
    float u_choice;       // a random number in [0, 1), renewed by each choice
    bool seen_by_camera;  // by its ray, at most through what is transparent
    int lobes;
    uint dropped_caustics;  // CausticKind of the lobes that the closure lacks, since a diffuse surface sees it
    bool is_bare;           // whether layers that reflect take no light from those below
    float least_alpha;      // of microfacets, as Filter Glossy blurs what blurred bounces see
};

// The only one that another may take the place of.
MicrofacetLobe last_lobe(Closure closure) { return unpacked_lobe(closure.lobes[CLOSURE_LOBES - 1]); }

// By constant numbers: what is indexed by others many drivers keep in memory.
void set_closure_lobe(inout Closure closure, int k, MicrofacetLobe lobe) {
    ClosureLobe made = packed_lobe(lobe);
    if (k == 0) closure.lobes[0] = made;
    else if (k == 1) closure.lobes[1] = made;
    else closure.lobes[2] = made;
}

// Where LOBES_IN_MEMORY names the array of closures, lobes go to that of the path resolved_path but for the last:
// processors have no registers for them beside what nodes compute.
void hold_lobe(inout ClosureBuilder builder, int k, MicrofacetLobe lobe) {
#ifdef LOBES_IN_MEMORY
    if (k < CLOSURE_LOBES - 1) {
        LOBES_IN_MEMORY[resolved_path].lobes[k] = usable_lobe(packed_lobe(lobe));
        return;
    }
#endif
    set_closure_lobe(builder.closure, k, lobe);
}

ClosureBuilder closure_builder(vec3 viewer, vec3 geometric, vec3 shading, bool backfacing, float u_choice) {
    ClosureBuilder builder =
        ClosureBuilder(empty_closure(), viewer, geometric, shading, backfacing, u_choice, false, 0, 0u, false, 0.0);
    builder.closure.diffuse_normal = pack_unit_vector(shading);
    return builder;
}

// For bump that belongs to the surface itself, before any shader has been added.
void set_shading_normal(inout ClosureBuilder builder, vec3 normal) {
    builder.shading = normal;
    builder.closure.diffuse_normal = pack_unit_vector(normal);
}

// True with a probability, and the random number is as good as new.
bool chance(inout ClosureBuilder builder, float probability) {
    if (probability > 0.0 && probability < 1.0) builder.closure.flags |= CLOSURE_CROWDED;
    bool chosen = builder.u_choice < probability;
    builder.u_choice = chosen ? builder.u_choice / probability : (builder.u_choice - probability) / (1.0 - probability);
    return chosen;
}

vec3 given_normal(ClosureBuilder builder, vec3 normal) {
    float length2 = dot(normal, normal);
    return length2 > 1e-12 ? normal * inversesqrt(length2) : builder.shading;
}

// A smooth, mapped or bumped normal may mirror the viewer's direction to below the surface, where nothing is seen. As
// in Cycles it is then bent toward the geometric normal g until the mirrored direction rises to `least` above the
// surface: with q = cos^2 of the angle of both normals, and the viewer at (x, z) in their plane,
// (x^2 + z^2) q^2 - (x^2 + z^2 + z least) q + (z + least)^2 / 4 = 0.
vec3 reflecting_normal(ClosureBuilder builder, vec3 normal) {
    normal = given_normal(builder, normal);
    vec3 g = builder.geometric, viewer = builder.viewer;
    float z = dot(viewer, g), least = min(0.9 * z, 0.01);
    if (dot(2.0 * dot(normal, viewer) * normal - viewer, g) >= least) return normal;
    vec3 across = normal - dot(normal, g) * g;
    float length2 = dot(across, across);
    if (length2 < 1e-12) return g;
    across *= inversesqrt(length2);
    float x = dot(viewer, across), square = x * x + z * z, linear = square + z * least;
    float root = sqrt(max(linear * linear - square * (z + least) * (z + least), 0.0));
    // The smaller root without the difference of numbers alike.
    float q = x < 0.0 ? 0.5 * (linear + root) / max(square, 1e-12)
                      : 0.5 * (z + least) * (z + least) / max(linear + root, 1e-12);
    q = clamp(q, 0.0, 1.0);
    return normalize(sqrt(1.0 - q) * across + sqrt(q) * g);
}

// One normal and roughness serve all diffuse light: of parts that differ, one is chosen by its albedo and stands
// for both, which leaves the mean as it is.
void add_diffuse_parts(inout ClosureBuilder builder, vec3 diffuse, vec3 translucent, vec3 normal, uint roughness) {
    float brightness = largest(diffuse) + largest(translucent);
    if (!(brightness > 0.0)) return;
    uint packed_normal = pack_unit_vector(given_normal(builder, normal));
    vec3 held_diffuse = builder.closure.diffuse, held_translucent = builder.closure.translucent;
    float held = largest(held_diffuse) + largest(held_translucent);
    if (largest(diffuse) <= 0.0 && roughness == 0u) roughness = builder.closure.diffuse_roughness;
    bool free = largest(held_diffuse) <= 0.0 && (builder.closure.diffuse_roughness & ROUGH_BEHIND) == 0u;
    bool alike =
        packed_normal == builder.closure.diffuse_normal && (free || roughness == builder.closure.diffuse_roughness);
    if (held <= 0.0 || alike) {
        builder.closure.diffuse_normal = packed_normal;
        builder.closure.diffuse_roughness = roughness;
        builder.closure.diffuse = held_diffuse + diffuse;
        builder.closure.translucent = held_translucent + translucent;
        return;
    }
    float probability = brightness / (brightness + held);
    if (chance(builder, probability)) {
        builder.closure.diffuse_normal = packed_normal;
        builder.closure.diffuse_roughness = roughness;
        builder.closure.diffuse = diffuse / probability;
        builder.closure.translucent = translucent / probability;
    } else {
        builder.closure.diffuse = held_diffuse / (1.0 - probability);
        builder.closure.translucent = held_translucent / (1.0 - probability);
    }
}

void add_diffuse(inout ClosureBuilder builder, vec3 weight, vec3 color, float roughness, vec3 normal) {
    add_diffuse_parts(builder, weight * color, vec3(0.0), normal, pack_diffuse_roughness(color, roughness));
}

// Rescale what a lobe scatters: glass keeps its tint of the passing light in f0.
void scale_lobe(inout MicrofacetLobe lobe, float factor) {
    lobe.weight *= factor;
    if (passes_by_f0(lobe.kind)) lobe.f0 *= factor;
}

// What is left of a lobe without some kinds of caustics.
MicrofacetLobe without_caustics(MicrofacetLobe lobe, uint dropped) {
    bool reflects = (dropped & CAUSTIC_REFLECTED) == 0u, refracts = (dropped & CAUSTIC_REFRACTED) == 0u;
    bool is_glass = passes_by_f0(lobe.kind), passes = lobe.kind == LOBE_REFRACTION || lobe.kind == LOBE_SHEET;
    bool is_caustic = lobe_has_facets(lobe.kind) || lobe.kind == LOBE_GLOSSY_TOON;
    if (is_caustic && (is_glass ? !reflects && !refracts : passes ? !refracts : !reflects)) lobe.kind = LOBE_NONE;
    if (is_glass && !reflects) lobe.weight = vec3(0.0);
    if (is_glass && !refracts) lobe.f0 = vec3(0.0);
    return lobe;
}

// A closure holds three lobes; of the third and any further one, one is chosen by its albedo and
// stands for both, which leaves the mean as it is.
void add_lobe(inout ClosureBuilder builder, MicrofacetLobe lobe) {
    if (builder.least_alpha > lobe.alpha && lobe_has_facets(lobe.kind)) {
        lobe.alpha = builder.least_alpha;
        lobe.anisotropy = ISOTROPIC;
    }
    if (builder.dropped_caustics != 0u) {
        lobe = without_caustics(lobe, builder.dropped_caustics);
        if (lobe.kind == LOBE_NONE) return;
    }
    float brightness = largest(lobe_albedo(lobe, lobe_cosine(lobe, builder.viewer)));
    if (brightness <= 0.0 && largest(lobe.weight) <= 0.0) return;
    if (builder.lobes < CLOSURE_LOBES) {
        hold_lobe(builder, builder.lobes, lobe);
        builder.lobes += 1;
        return;
    }
    MicrofacetLobe held = last_lobe(builder.closure);
    float held_brightness = largest(lobe_albedo(held, lobe_cosine(held, builder.viewer)));
    float probability = brightness / max(brightness + held_brightness, 1e-20);
    bool chosen = chance(builder, probability);
    if (!chosen) lobe = held;
    scale_lobe(lobe, 1.0 / max(chosen ? probability : 1.0 - probability, 1e-20));
    hold_lobe(builder, CLOSURE_LOBES - 1, lobe);
}

void add_holdout(inout ClosureBuilder builder, float weight) {
    float holdout = clamp(closure_holdout(builder.closure) + weight, 0.0, 1.0);
    builder.closure.flags = (builder.closure.flags & 0xffffu) | packUnorm2x16(vec2(0.0, holdout));
}
