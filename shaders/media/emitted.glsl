// SPDX-License-Identifier: GPL-3.0-or-later
// Whether light of a medium comes from within the surface that encloses it. The includer includes
// media/crossings.glsl before.

readonly buffer EmissiveMedia;
#include <EmissionPlaces>

// How many times a place lies within the medium of an instance, counted as media_at does; media: all media there.
uint times_within(vec3 point, EmissiveMedium source, out uint media) {
    media = 0u;
    if (source.instance == AROUND_EVERYTHING) {
        media = media_at(point);
        return 1u;
    }
    if (!may_cross(point, point)) return 0u;
    Ray ray = Ray(point, NO_TRIANGLE, OUTWARD, INFINITY_DISTANCE);
    uint entered = 0u, entered_source = 0u, times = 0u;
    for (int count = 0; count < MOST_CROSSINGS; ++count) {
        Crossing crossing = next_crossing(ray);
        if (crossing.medium == 0u) break;
        bool is_source = crossing.medium == source.medium && instance_of(ray.source_triangle) == source.instance;
        uint without = leave_medium(entered, crossing.medium);
        if (!crossing.leaves) {
            entered = enter_medium(entered, crossing.medium);
            if (is_source) ++entered_source;
            continue;
        }
        if (without != entered) entered = without;
        else media = enter_medium(media, crossing.medium);
        if (!is_source) continue;
        if (entered_source > 0u) --entered_source;
        else ++times;
    }
    return times;
}
