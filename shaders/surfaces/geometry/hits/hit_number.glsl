// SPDX-License-Identifier: GPL-3.0-or-later
readonly buffer Hits;

// The triangle that a path has hit.
uint hit_number(uint path) { return hits[path].triangle; }
