#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// A viewport's picture of what there is: the last picture, moved into the new view by depth, and a new one that may be
// coarse, whose pixels count where they show the same surface. Joint bilateral upsampling after Kopf et al. (2007);
// reprojection with the depths of the new view after Nehab et al. (2007), so that outlines are those of the new view.

layout(local_size_x = 64) in;

#include <ReprojectionParameters>
#include <CameraView>
#include "common/finite.glsl"
#include "common/invocation.glsl"
#include "common/luminance.glsl"
#include "camera_paths/gbuffer/projections.glsl"
uniform Parameters { ReprojectionParameters parameters; };
readonly buffer Camera;
readonly buffer LastCamera { CameraView last_camera; };
readonly buffer LastPicture { vec4 last_picture[]; };
readonly buffer LastCounts { float last_counts[]; };
readonly buffer NewPicture { vec4 new_picture[]; };
writeonly buffer Picture { vec4 picture[]; };
writeonly buffer Counts { float counts[]; };
uniform sampler2D surfaces;
uniform sampler2D numbers;
uniform sampler2D plain_picture;
uniform sampler2D last_surfaces;
uniform sampler2D last_numbers;

const float SAME_NORMAL = 0.8, SAME_DEPTH = 0.02, NEAR_DEPTH = 0.1;
const float MIN_WEIGHT = 0.05;
// How much brighter than all that is new around it a specular surface may stay: glints move over it with the view.
const float BRIGHTER_KEPT = 1.0;
const uint SEARCHED = 32u, ENOUGH = 8u;
const float SEARCH_STEP = 1.5, GOLDEN_ANGLE = 2.39996323;

// A pixel's surface: normal and view depth; instance and material, 0 of the background.
struct VisibleSurface {
    vec3 normal;
    float depth;
    vec2 number;
};
struct Sum {
    vec4 color;
    float count;
    float weight;
};

ivec2 size_of(CameraView view) { return ivec2(view.width, view.height); }

bool is_specular(VisibleSurface surface) { return (uint(surface.number.y + 0.5) & 1u) != 0u; }

VisibleSurface surface_at(ivec2 pixel) {
    vec4 surface = texelFetch(surfaces, pixel, 0);
    return VisibleSurface(surface.xyz, surface.w, texelFetch(numbers, pixel, 0).xy);
}

VisibleSurface last_surface_at(ivec2 pixel) {
    vec4 surface = texelFetch(last_surfaces, pixel, 0);
    return VisibleSurface(surface.xyz, surface.w, texelFetch(last_numbers, pixel, 0).xy);
}

// What differences of depth are measured by: the depth, or what a view of parallel rays is wide.
float depth_scale(float depth) {
    return camera.projection == PROJECTION_ORTHOGRAPHIC ? camera.window.y - camera.window.x : depth;
}

bool shows_the_same(VisibleSurface a, VisibleSurface b) {
    return a.number == b.number && dot(a.normal, b.normal) >= SAME_NORMAL * dot(a.normal, a.normal);
}

// Where the last picture had what a pixel sees, in its pixels, and how deep; false where it was behind that camera.
bool find_last_place(ivec2 pixel, VisibleSurface surface, out vec3 place) {
    bool parallel = camera.projection == PROJECTION_ORTHOGRAPHIC, background = surface.number.x == 0.0;
    vec2 at = mix(camera.window.xz, camera.window.yw, (vec2(pixel) + 0.5) / vec2(size_of(camera)));
    place = vec3(vec2(pixel) + 0.5, 0.0);
    if (parallel && background) return true;
    vec3 axis = parallel ? vec3(at, surface.depth) : (background ? 1.0 : surface.depth) * vec3(at, 1.0);
    vec3 offset = mat3(camera.right, camera.up, camera.forward) * axis;
    if (!background) offset += camera.position - last_camera.position + parameters.way_of_origins;
    vec3 p = vec3(dot(offset, last_camera.right), dot(offset, last_camera.up), dot(offset, last_camera.forward));
    if (!parallel && !(p.z > 0.0)) return false;
    vec2 window = parallel ? p.xy : p.xy / p.z;
    vec2 at_last = (window - last_camera.window.xz) / (last_camera.window.yw - last_camera.window.xz);
    place = vec3(at_last * vec2(size_of(last_camera)), p.z);
    return true;
}

void add_last(ivec2 pixel, float weight, inout Sum sum) {
    uint index = uint(pixel.y * size_of(last_camera).x + pixel.x);
    sum.color += weight * last_picture[index];
    sum.count += weight * last_counts[index];
    sum.weight += weight;
}

Sum moved(VisibleSurface surface, vec3 place) {
    Sum sum = Sum(vec4(0.0), 0.0, 0.0);
    ivec2 size = size_of(last_camera), low = ivec2(floor(place.xy - 0.5));
    vec2 part = place.xy - 0.5 - vec2(low);
    if (any(lessThan(place.xy, vec2(-0.5))) || any(greaterThan(place.xy, vec2(size) + 0.5))) return sum;
    for (int corner = 0; corner < 4; ++corner) {
        ivec2 step = ivec2(corner & 1, corner >> 1), pixel = clamp(low + step, ivec2(0), size - 1);
        VisibleSurface last = last_surface_at(pixel);
        vec2 near = mix(1.0 - part, part, vec2(step));
        bool near_enough = surface.number.x == 0.0 || abs(last.depth - place.z) <= SAME_DEPTH * depth_scale(place.z);
        if (!shows_the_same(surface, last) || !near_enough) continue;
        add_last(pixel, near.x * near.y + 1e-4, sum);
    }
    return sum;
}

// What the last picture shows of the same object and material around the place.
Sum filled(VisibleSurface surface, vec3 place) {
    Sum sum = Sum(vec4(0.0), 0.0, 0.0);
    ivec2 last = size_of(last_camera) - 1;
    vec2 middle = clamp(place.xy, vec2(0.0), vec2(last + 1));
    for (uint tap = 0u; tap < SEARCHED && sum.weight < float(ENOUGH); ++tap) {
        float angle = GOLDEN_ANGLE * float(tap);
        vec2 offset = SEARCH_STEP * float(tap) * vec2(cos(angle), sin(angle));
        ivec2 pixel = clamp(ivec2(floor(middle + offset)), ivec2(0), last);
        VisibleSurface there = last_surface_at(pixel);
        if (there.number == surface.number) add_last(pixel, 1.0, sum);
    }
    return sum;
}

ivec2 new_size() { return ivec2(parameters.new_width, parameters.new_height); }

vec4 new_at(ivec2 pixel) {
    vec4 color = new_picture[uint(pixel.y) * parameters.new_width + uint(pixel.x)];
    return is_finite(color.rgb) ? vec4(parameters.exposure * color.rgb, clamp(color.a, 0.0, 1.0)) : vec4(0.0);
}

// The brightest that is new around a pixel; light that is taken away counts alike.
float brightest_around(ivec2 pixel) {
    ivec2 middle = pixel * new_size() / size_of(camera);
    float brightest = 0.0;
    for (int k = 0; k < 9; ++k) {
        ivec2 near = clamp(middle + ivec2(k % 3, k / 3) - 1, ivec2(0), new_size() - 1);
        brightest = max(brightest, abs(luminance(new_at(near).rgb)));
    }
    return brightest;
}

// The new picture's pixels around, within reach of its pixels, that show the same; all of them where none does.
vec4 upsampled(ivec2 pixel, VisibleSurface surface) {
    vec2 scale = vec2(size_of(camera)) / vec2(new_size()), place = (vec2(pixel) + 0.5) / scale - 0.5;
    ivec2 low = ivec2(floor(place));
    vec4 same = vec4(0.0), all_around = vec4(0.0);
    float weight = 0.0, all_weight = 0.0;
    for (int y = -1; y <= 2; ++y) {
        for (int x = -1; x <= 2; ++x) {
            ivec2 tap = low + ivec2(x, y), inside = clamp(tap, ivec2(0), new_size() - 1);
            vec2 near = max(1.0 - 0.5 * abs(vec2(tap) - place), 0.0);
            float bilinear = near.x * near.y;
            vec4 color = new_at(inside);
            all_around += bilinear * color;
            all_weight += bilinear;
            VisibleSurface other =
                surface_at(clamp(ivec2((vec2(inside) + 0.5) * scale), ivec2(0), size_of(camera) - 1));
            if (!shows_the_same(surface, other)) continue;
            if (abs(other.depth - surface.depth) > NEAR_DEPTH * depth_scale(surface.depth)) continue;
            same += bilinear * color;
            weight += bilinear;
        }
    }
    return weight > MIN_WEIGHT ? same / weight : all_around / all_weight;
}

void main() {
    uint index = invocation_index();
    if (index >= camera.width * camera.height) return;
    ivec2 pixel = ivec2(index % camera.width, index / camera.width);
    VisibleSurface surface = surface_at(pixel);
    vec4 color = vec4(0.0);
    float count = 0.0;
    if (parameters.new_count > 0.0) {
        color = new_size() == size_of(camera) ? new_at(pixel) : upsampled(pixel, surface);
        count = parameters.new_count;
    }
    if (parameters.max_history > 0.0) {
        vec3 place;
        bool in_front = find_last_place(pixel, surface, place);
        Sum last = Sum(vec4(0.0), 0.0, 0.0);
        if (in_front) last = moved(surface, place);
        bool has_history = last.weight > 0.0;
        if (in_front && !has_history && count == 0.0) last = filled(surface, place);
        if (last.weight > 0.0) {
            bool specular = is_specular(surface);
            float max_count = specular ? parameters.max_specular_history : parameters.max_history;
            float history = has_history ? min(last.count / last.weight, max_count) : 0.0;
            vec4 before = last.color / last.weight;
            if (specular && count > 0.0) {
                float brightness = max(abs(luminance(before.rgb)), 1e-20);
                before.rgb *= min(1.0, BRIGHTER_KEPT * brightest_around(pixel) / brightness);
            }
            color = count == 0.0 ? before : mix(color, before, history / (history + count));
            count += history;
        } else if (count == 0.0) {
            color = texelFetch(plain_picture, pixel, 0);
        }
    }
    picture[index] = color;
    counts[index] = count;
}
