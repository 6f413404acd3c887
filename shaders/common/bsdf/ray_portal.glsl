// SPDX-License-Identifier: GPL-3.0-or-later
// Ray portals, as closures keep them: in the place of their last lobe, behind those that they count, where nothing goes
// below the surface. A path that comes to a ray portal goes on from another place, or in another direction.

#include "common/bsdf/closure.glsl"

struct RayPortal {
    vec3 weight;
    vec3 position;  // from which paths go on
    vec3 direction;
    bool moves;  // whether that place is another one
};

const RayPortal NO_RAY_PORTAL = RayPortal(vec3(0.0), vec3(0.0), vec3(0.0), false);

// The alphas of lobes that stand for a ray portal. The words of the lobe that nobody limits hold the position.
const float RAY_PORTAL_IN_PLACE = 0.5, RAY_PORTAL_MOVING = 1.0;

ClosureLobe packed_ray_portal(RayPortal portal) {
    uvec3 place = floatBitsToUint(portal.position);
    return ClosureLobe(portal.weight, place.x, portal.direction, portal.moves ? RAY_PORTAL_MOVING : RAY_PORTAL_IN_PLACE,
                       1.0, place.y, place.z);
}

RayPortal unpacked_ray_portal(ClosureLobe lobe) {
    return RayPortal(lobe.weight, uintBitsToFloat(uvec3(lobe.kind, lobe.normal, lobe.anisotropy)), lobe.f0,
                     lobe.alpha == RAY_PORTAL_MOVING);
}

// The weight of the ray portal of a closure, 0 where it has none or paths may not take it. last: its last lobe.
vec3 ray_portal_weight(Closure closure, ClosureLobe last) {
    bool has_none =
        (closure.flags & (CLOSURE_SUBSURFACE | CLOSURE_KEEPS_LIGHT)) != 0u || closure_lobes(closure) == CLOSURE_LOBES;
    return has_none || !(last.alpha > 0.0) ? vec3(0.0) : last.weight;
}

// How much of what lies behind a surface is seen through it, as passes distinguish surfaces: that of the place to which
// a ray portal leads as well.
vec3 seen_beyond(Closure closure) {
#ifdef RAY_PORTALS
    return closure.transparent + ray_portal_weight(closure, closure.lobes[CLOSURE_LOBES - 1]);
#else
    return closure.transparent;
#endif
}
