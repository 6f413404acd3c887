// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles to be found in the texels of a view: (triangle, view, first texel, last texel), texels as x | y << 16.
#include <LightGBufferCounts>
buffer LightJobs {
    LightGBufferCounts light_counts;
    uvec4 light_jobs[];
};

ivec2 job_texel(uint packed_texel) { return ivec2(packed_texel & 0xffffu, packed_texel >> 16); }
