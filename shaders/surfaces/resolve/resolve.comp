#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// DIRT's deferred fetch: hits become closures. The only stage that knows materials: a program for each structure of
// node graphs resolves the hits on them.

layout(local_size_x = 64) in;

#include <ResolveParameters>
#include "common/invocation.glsl"
#include "common/random.glsl"
uniform Parameters { ResolveParameters parameters; };
#include "materials/usable.glsl"
writeonly buffer Closures;
// Drivers on the processor have registers in memory anyway.
#ifndef READS_TEXELS
#define LOBES_IN_MEMORY closures
uint resolved_path;
#endif
#include "materials/data.glsl"
#include "materials/surface.glsl"
#include "materials/builder.glsl"
#include "common/photon.glsl"
#include "common/path_depth.glsl"
#include "common/light_sets.glsl"
#include "surfaces/resolve/ranges.glsl"

readonly buffer Rays;
readonly buffer Hits;
readonly buffer Materials;
readonly buffer PathFlags { uint path_words[]; };

#include "materials/generated.glsl"

#include <PathKinds>
#include <RayPortalPaths>
#include <AdjointSegments>

uint path_flags(uint index) {
    if (parameters.path_kind == PATH_OF_CAMERA)
        return path_words[parameters.camera_stride * index + parameters.camera_flags];
    return parameters.path_kind == PATH_OF_PHOTON
               ? path_words[parameters.photon_stride * index + parameters.photon_flags]
               : 0u;
}

// That of a path that came to a surface; to none other, where lights are sampled, of which nothing is asked.
uint path_depth(uint index) {
    if (parameters.path_kind == PATH_OF_CAMERA)
        return path_words[parameters.camera_stride * index + parameters.camera_depth];
    return parameters.path_kind == PATH_OF_PHOTON
               ? path_words[parameters.photon_stride * index + parameters.photon_depth]
               : parameters.segment;
}

// The bounces of a path by type, 0 where its stages do not count them. Photons come as from a diffuse surface.
uint path_bounce_counts(uint index) {
    if (parameters.path_kind == PATH_OF_CAMERA)
        return path_words[parameters.camera_stride * index + parameters.camera_bounce_counts];
    return parameters.path_kind == PATH_OF_PHOTON ? counted(0u, SCATTER_DIFFUSE) : 0u;
}

// The number of ray portals that a path has passed.
uint path_portals(uint index) {
    return parameters.path_kind == PATH_OF_CAMERA
               ? path_words[parameters.camera_stride * index + parameters.camera_lit_from] / ONE_RAY_PORTAL
               : 0u;
}

// How far a path had come straight through surfaces before its ray began.
float straight_length(uint index) {
    return parameters.path_kind == PATH_OF_CAMERA
               ? uintBitsToFloat(path_words[parameters.camera_stride * index + parameters.camera_straight_length])
               : 0.0;
}

// A shadow ray along the reflection of a mirror stands for the path that the mirror would send there, and comes to
// surfaces as one.
uint shadow_ray_kind(uint index) {
    float code = uintBitsToFloat(path_words[4u * index + 3u]);  // the last component of a contribution
    return is_reflected_code(code) ? RAY_GLOSSY | RAY_SINGULAR : RAY_SHADOW;
}

// flags: of the path that came there; index: its number, whose closure gets the offset of its rays.
Surface surface_at(Ray ray, Hit hit, uint flags, uint index) {
    vec3 v0, v1, v2;
    triangle_points(hit.triangle, v0, v1, v2);
    vec3 b = vec3(1.0 - hit.b1 - hit.b2, hit.b1, hit.b2);
    Surface surface;
    surface.viewer = -ray.direction;
    surface.geometric = normalize(cross(v1 - v0, v2 - v0));
    vec3 shading = triangle_normal(hit.triangle, b);
    float shading_length = length(shading);
    shading = shading_length > 1e-6 ? shading / shading_length : surface.geometric;
    surface.backfacing = dot(surface.geometric, surface.viewer) < 0.0;
    // As in Cycles, wherever the normals of the corners point: both turn where the face is seen from behind.
    if (surface.backfacing) surface.geometric = -surface.geometric;
    closures[index].ray_offset = ray_offset(surface.geometric, v0, v1, v2);
    surface.normal = surface.backfacing ? -shading : shading;
    surface.position = b.x * v0 + b.y * v1 + b.z * v2;
    surface.barycentrics = b;
    surface.beside = vec3(0.0);
    surface.triangle = hit.triangle;
    surface.uv = triangle_uv(hit.triangle, b);
    surface.instance = attributes[hit.triangle].instance;
    // Where lights are sampled, no path has come to them, and it is of no kind, as in Cycles.
    surface.ray = parameters.path_kind == PATH_OF_CAMERA   ? camera_ray_kind(flags)
                  : parameters.path_kind == PATH_OF_PHOTON ? RAY_DIFFUSE
                  : parameters.path_kind == PATH_OF_SHADOW ? shadow_ray_kind(index)
                                                           : 0u;
    surface.ray_length = straight_length(index) + hit.distance;
    uint depth = path_depth(index);
    surface.ray_depth = bounces_of(depth) + (parameters.path_kind == PATH_OF_CAMERA ? 0u : 1u);
    surface.transparent_depth = transparents_of(depth);
    surface.bounce_counts = path_bounce_counts(index);
    surface.portal_depth = path_portals(index);
#ifdef ROUND_SHAPES
    make_round(surface);
#endif
    return surface;
}

#ifdef DISPERSES
// One for all vertices of a path; but behind each vertex where a camera path gathers, another. Those of photons are
// spread evenly over the paths of an iteration, those of a pixel over its iterations (Roberts' R1 sequence, 2018).
float wavelength_choice(uint index, uint flags) {
    const uint golden = 2654435769u;
    bool photon = parameters.path_kind == PATH_OF_PHOTON;
    bool gathered = !photon && (flags & PATH_FINAL_GATHER) != 0u;
    uint gathers = gathered ? flags & (PATH_FINAL_GATHER | PATH_SECONDARY_GATHER) : 0u;
    uint start = pcg4d(uvec4(photon ? parameters.iteration : index, gathers, parameters.seed,
                             STAGE_WAVELENGTH << 24u | parameters.path_kind))
                     .x;
    return unit_float(start + golden * (photon ? index : parameters.iteration));
}
#endif

// As in Cycles, blurred bounces blur the reflections and refractions that they see. Photons do not know where they will
// be gathered: as the final gather they take the mean of a diffuse bounce. Other rays know the pdfs of their path, but
// do not make lobes gather photons where no photons are stored.
float least_alpha(uint index, uint flags) {
    if (parameters.filter_pdf_scale <= 0.0) return 0.0;
    if (parameters.path_kind == PATH_OF_PHOTON) return parameters.gathered_alpha;
    if (parameters.path_kind != PATH_OF_CAMERA) return 0.0;
    if ((flags & PATH_FINAL_GATHER) != 0u) return parameters.gathered_alpha;
    float pdf = uintBitsToFloat(path_words[parameters.camera_stride * index + parameters.camera_least_pdf]);
    float alpha = 0.5 * sqrt(max(1.0 - parameters.filter_pdf_scale * pdf, 0.0));
    return min(alpha, max(parameters.gathered_alpha, parameters.specular_alpha));
}

ClosureBuilder builder_at(Surface surface, float u_choice) {
    ClosureBuilder builder =
        closure_builder(surface.viewer, surface.geometric, surface.normal, surface.backfacing, u_choice);
    // As in Cycles, surfaces that diffuse ones see lack the lobes of caustics that are left out. Photons keep them, as
    // who sees the light that they bring is not known yet (photons/sample_next_ray.glsl).
    uint dropped = (surface.ray & RAY_DIFFUSE) != 0u ? parameters.dropped_caustics : 0u;
    builder.dropped_caustics = parameters.path_kind == PATH_OF_CAMERA ? dropped : 0u;
    builder.is_bare = (dropped & CAUSTIC_REFLECTED) != 0u;
    return builder;
}

// What an object that is a holdout, or catches shadows, does to its closure.
void hold_out_and_catch(Surface surface, ShadingInstance instance, bool unseen, inout ClosureBuilder builder) {
    bool seen_by_camera = parameters.path_kind == PATH_OF_CAMERA && (surface.ray & RAY_CAMERA) != 0u;
    if (seen_by_camera && instance.holdout != 0u) {
        vec3 transparent = clamp(builder.closure.transparent, 0.0, 1.0);
        builder = builder_at(surface, 0.0);
        builder.closure.transparent = transparent;
        add_holdout(builder, 1.0 - mean(transparent));
    }
    if (seen_by_camera && instance.shadow_catcher != 0u && !unseen) {
        builder = builder_at(surface, 0.0);
        builder.closure.flags |= CLOSURE_CATCHES_SHADOWS;
    }
}

// What of the light an object lets pass, by whom it may be seen. flags: of the path.
void let_light_pass(Surface surface, ShadingInstance instance, uint flags, bool unseen, uint material,
                    inout ClosureBuilder builder) {
    bool opaque_shadow = materials[material].opaque_shadow != 0u,
         passes_shadow_rays = materials[material].passes_shadow_rays != 0u;
    bool camera = parameters.path_kind == PATH_OF_CAMERA, photon = parameters.path_kind == PATH_OF_PHOTON;
    // Light reaches what casts no shadow, and what lies behind it too.
    bool shadowless = photon && (flags & PHOTON_DIRECT) != 0u && (instance.visibility & RAY_SHADOW) == 0u;
    // What diffuse surfaces do not see is lit, but gives no light, and light from other surfaces goes on through it.
    bool keeps_light = photon && (instance.visibility & RAY_DIFFUSE) == 0u;
    bool passes = unseen || shadowless || (keeps_light && (flags & PHOTON_DIRECT) == 0u);
    bool opaque = photon && (flags & PHOTON_CASTS_SHADOWS) != 0u && opaque_shadow;
    if (passes || (builder.closure.flags & CLOSURE_CATCHES_SHADOWS) != 0u) builder.closure.transparent = vec3(1.0);
    else if (opaque) builder.closure.transparent = vec3(0.0);
    if (passes) builder.closure.flags |= CLOSURE_ABSENT;
    if (unseen) builder.closure.flags |= CLOSURE_UNSEEN;
    if (keeps_light) builder.closure.flags |= CLOSURE_KEEPS_LIGHT;
    // Shadow rays bring light through what is transparent, and photons and paths leave it to them.
    bool leaves_direct_light =
        shadowless || passes_shadow_rays || (camera && (unseen || (instance.visibility & RAY_SHADOW) == 0u));
    builder.closure.flags |=
        (surface.backfacing ? CLOSURE_BACKFACING : 0u) | (leaves_direct_light ? CLOSURE_SHADOWLESS : 0u);
}

#ifdef ASKS_FOR_SHADOW_RAYS
// What photons straight from their light leave of it to what lies behind: the light that shadow rays bring there.
vec3 shadow_ray_transparency(Surface surface, uint first_constant, float u_choice) {
    surface.ray = RAY_SHADOW;
    ClosureBuilder builder = builder_at(surface, u_choice);
    evaluate_material(surface, first_constant, builder);
#ifdef MATERIAL_SUBSURFACE
    material_subsurface = NO_SUBSURFACE;
#endif
    return builder.closure.transparent;
}
#endif

// flags: of the path.
void evaluate_nodes(Surface surface, uint material, uint flags, float u_choice, inout ClosureBuilder builder) {
    uint first_constant = materials[material].first_constant;
#ifdef ASKS_FOR_SHADOW_RAYS
    // First, since lobes may lie where those of the other closure do.
    bool passes_light = parameters.path_kind == PATH_OF_PHOTON && (flags & PHOTON_DIRECT) != 0u
                        && materials[material].passes_shadow_rays != 0u;
    vec3 transparency = vec3(0.0);
    if (passes_light) transparency = shadow_ray_transparency(surface, first_constant, u_choice);
#endif
    evaluate_material(surface, first_constant, builder);
#ifdef ASKS_FOR_SHADOW_RAYS
    if (passes_light) builder.closure.transparent = transparency;
#endif
}

// Whether light that a camera path meets shines on where its ray began; the camera sees all.
bool shines_there(Surface surface, ShadingInstance instance, uint source_triangle) {
    uvec2 light_sets = uvec2(instance.light_sets0, instance.light_sets1);
    if (light_sets == uvec2(~0u) || parameters.path_kind != PATH_OF_CAMERA || (surface.ray & RAY_CAMERA) != 0u
        || source_triangle == NO_TRIANGLE)
        return true;
    return has_set(light_sets, light_set_of(triangle_vertices[3u * source_triangle].w));
}

void store(uint index, Closure closure) {
    closures[index].position = closure.position;
    closures[index].triangle = closure.triangle;
    closures[index].diffuse = closure.diffuse;
    closures[index].flags = closure.flags;
    closures[index].emission = closure.emission;
    closures[index].geometric_normal = closure.geometric_normal;
    closures[index].transparent = closure.transparent;
    closures[index].shading_normal = closure.shading_normal;
    closures[index].translucent = closure.translucent;
    closures[index].diffuse_normal = closure.diffuse_normal;
    closures[index].distance = closure.distance;
    closures[index].material = closure.material;
    closures[index].diffuse_roughness = closure.diffuse_roughness;
#ifdef LOBES_IN_MEMORY
    LOBES_IN_MEMORY[index].lobes[CLOSURE_LOBES - 1] = closure.lobes[CLOSURE_LOBES - 1];
#else
    closures[index].lobes = closure.lobes;
#endif
}

#ifdef MATERIAL_SUBSURFACE
void hold_subsurface_of(ShadingInstance instance, inout ClosureBuilder builder) {
#ifdef ROUND_SHAPES
    // Rays do not see strands and points from within; Cycles loses what goes there.
    if (instance.shape != SHAPE_SURFACE && largest(material_subsurface.weight) > 0.0) {
        add_diffuse_parts(builder, material_subsurface.weight, vec3(0.0),
                          unpack_unit_vector(material_subsurface.normal), 0u);
        material_subsurface.weight = vec3(0.0);
    }
#endif
    hold_subsurface(builder);
}
#endif

// Where the closure is.
void set_place(Surface surface, Hit hit, uint material, ShadingInstance instance, inout ClosureBuilder builder) {
    builder.closure.position = surface.position;
    builder.closure.triangle = hit.triangle;
    builder.closure.material = material;
    builder.closure.distance = hit.distance;
    builder.closure.geometric_normal = pack_unit_vector(surface.geometric);
    builder.closure.shading_normal = pack_unit_vector(builder.shading);
#ifdef UNCORRECTED_BUMP
    builder.closure.shading_normal = builder.closure.diffuse_normal;  // so that its slopes shadow nothing
#endif
    builder.closure.flags |= uint(builder.lobes) << LOBE_COUNT_SHIFT | instance.terminator_flags;
}

void main() {
    uint place = invocation_index();
    if (place >= range_length(parameters.program)) return;
    uint index = hit_order[range_first(parameters.program) + place];
    Ray ray = rays[index];
    Hit hit = hits[index];
    // Where one program resolves all, misses are in its range.
    if (!(ray.maximum_distance > 0.0) || hit.triangle == NO_TRIANGLE) {
        closures[index].triangle = NO_TRIANGLE;  // the rest of it is never read
        return;
    }
#ifdef LOBES_IN_MEMORY
    resolved_path = index;
#endif
#ifdef NODE_RAYS
    path_of_node_rays = index;
#endif
    uint flags = path_flags(index);
    Surface surface = surface_at(ray, hit, flags, index);
    uint variant = parameters.has_adjoint_queries != 0u ? ADJOINT_SEGMENT_OFFSET : 0u;
    RandomSequence random =
        random_sequence(parameters.seed, parameters.iteration, STAGE_RESOLVE, parameters.segment + variant, index);
    ClosureBuilder builder = builder_at(surface, next_random(random));
    builder.seen_by_camera = (surface.ray & RAY_CAMERA) != 0u;
    builder.least_alpha = least_alpha(index, flags);
    uint material = attributes[hit.triangle].material;
    ShadingInstance instance = shading_instances[surface.instance];
#ifdef DISPERSES
    if (parameters.path_kind != PATH_OF_NONE) {
        take_wavelength(wavelength_choice(index, flags), (flags & PATH_DISPERSED) == 0u);
        builder.closure.flags |= CLOSURE_DISPERSES;
    }
#endif
    bool unseen =
        parameters.path_kind == PATH_OF_CAMERA && (instance.visibility & surface.ray & RAYS_WITH_VISIBILITY) == 0u;
    if (!unseen) evaluate_nodes(surface, material, flags, next_random(random), builder);
#ifdef MATERIAL_RAY_PORTAL
    hold_ray_portal(surface, builder);
#endif
#ifdef MATERIAL_SUBSURFACE
    hold_subsurface_of(instance, builder);
#endif
#ifdef MATERIAL_AOVS
    // As in Cycles: of what is seen up to the first surface that the passes are of.
    bool seen_first = parameters.path_kind == PATH_OF_CAMERA
                      && (flags & (PATH_CAMERA_TRANSPARENT | PATH_SURFACE_FOUND)) == PATH_CAMERA_TRANSPARENT;
    if (seen_first && !unseen) evaluate_aovs(surface, materials[material].first_constant, index);
#endif
#ifdef NODE_RAYS
    if (asks_rays()) return;
#endif
    hold_out_and_catch(surface, instance, unseen, builder);
    if (!shines_there(surface, instance, ray.source_triangle)) builder.closure.emission = vec3(0.0);
    let_light_pass(surface, instance, flags, unseen, material, builder);
    set_place(surface, hit, material, instance, builder);
    make_usable(builder.closure);
    store(index, builder.closure);
}
