// SPDX-License-Identifier: GPL-3.0-or-later

// Of Rec. 709.
float luminance(vec3 color) { return dot(color, vec3(0.2126391, 0.7151691, 0.0721928)); }
