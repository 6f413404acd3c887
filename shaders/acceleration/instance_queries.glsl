// SPDX-License-Identifier: GPL-3.0-or-later
// What kernels ask of two levels. The includer defines before Hit trace_ray(Ray ray, bool any_hit).

// The nearest hit within ray.maximum_distance (which may be it); best.triangle NO_TRIANGLE if none.
Hit nearest_hit(Ray ray) {
    Hit best = trace_ray(ray, false);
    if (is_on_instance(best)) best.triangle = keep_hit(hit_origin(best), ray.source_triangle);
    return best;
}

// Whether anything lies within ray.maximum_distance.
bool is_occluded(Ray ray) { return trace_ray(ray, true).triangle != NO_TRIANGLE; }
