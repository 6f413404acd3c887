// SPDX-License-Identifier: GPL-3.0-or-later

// The radius in which caustic photons count at an importon where they do not know their footprint, as those of the
// environment.
float disk_radius(float minimum, float maximum) { return min(3.0 * minimum, maximum); }
