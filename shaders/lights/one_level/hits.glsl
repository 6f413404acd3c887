// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers of world triangles that emit. lights/two_levels/hits.glsl stands in for this file where some emissive
// triangles are those of instances.

// The triangle that a path's shadow ray goes to.
uint keep_sampled_emitter(EmitterNumber triangle, uint path) { return triangle; }

// The triangle that a path's photon has left.
uint keep_left_emitter(EmitterNumber triangle, uint path) { return triangle; }
