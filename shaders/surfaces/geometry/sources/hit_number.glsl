// SPDX-License-Identifier: GPL-3.0-or-later
readonly buffer Rays;

// The triangle that a path's ray comes from.
uint hit_number(uint path) { return rays[path].source_triangle; }
