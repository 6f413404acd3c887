// SPDX-License-Identifier: GPL-3.0-or-later
// What all kernels know of the cubemap: where it is, how fine, how much it holds.
// Build kernels, which count in it, define DEEP_CUBEMAP_BUILD first.
#include <DeepCubemapState>
#include "deep_cubemap/sortable_bits.glsl"

#ifdef DEEP_CUBEMAP_BUILD
#define DEEP_CUBEMAP_ACCESS
#else
#define DEEP_CUBEMAP_ACCESS restrict readonly
#endif

DEEP_CUBEMAP_ACCESS buffer DeepCubemap { DeepCubemapState deep_cubemap; };
