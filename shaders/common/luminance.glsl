// SPDX-License-Identifier: GPL-3.0-or-later

// Of the working space in programs of node graphs, else of Rec. 709, which is near enough where chances follow from it.
#ifndef WORKING_LUMINANCE
#define WORKING_LUMINANCE vec3(0.2126391, 0.7151691, 0.0721928)
#endif
float luminance(vec3 color) { return dot(color, WORKING_LUMINANCE); }
