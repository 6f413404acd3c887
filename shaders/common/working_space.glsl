// SPDX-License-Identifier: GPL-3.0-or-later
// Colors that follow from spectra, in the scene's working space (rppm_addon/scene/common/working_space.py).

#ifndef XYZ_TO_WORKING
#define XYZ_TO_WORKING \
    mat3(3.2404542, -0.9692660, 0.0556434, -1.5371385, 1.8760108, -0.2040259, -0.4985314, 0.0415560, 1.0572252)
#endif

vec3 from_xyz(vec3 color) {
    const mat3 to_working = XYZ_TO_WORKING;
    return to_working * color;
}

vec3 from_rec709(vec3 color) {
#ifdef REC709_TO_WORKING
    const mat3 to_working = REC709_TO_WORKING;
    return to_working * color;
#else
    return color;
#endif
}
