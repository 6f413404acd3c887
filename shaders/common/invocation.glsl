// SPDX-License-Identifier: GPL-3.0-or-later
// Index of this thread when a one-dimensional dispatch is folded into rows of groups, or cut into pieces.

layout(location = 0) uniform uint first_invocation;  // of the piece (gl/context/pacing.py)
#ifdef READS_TEXELS
layout(location = 1) uniform uint driver_threads;  // of llvmpipe (gl/programs/program.py); 0: it is another driver

// llvmpipe gives each of its threads one sequence of groups. Groups that follow each other cost about the same, so they
// are dealt to the threads in turn: otherwise one thread has the sky, and waits for the one that has the ground.
uint dealt_group(uint group, uint count) {
    if (driver_threads < 2u || count >= 1u << 20) return group;  // more than floats tell apart below
    uint share = uint(float(count) / float(driver_threads));
    share = share + uint((share + 1u) * driver_threads <= count) - uint(share * driver_threads > count);
    if (group >= share * driver_threads) return group;  // the rest, which it deals itself
    uint thread = uint((float(group) + 0.5) / float(share));
    return (group - thread * share) * driver_threads + thread;
}
#else
uint dealt_group(uint group, uint count) { return group; }
#endif

uint invocation_index() {
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    group = dealt_group(group, gl_NumWorkGroups.x * gl_NumWorkGroups.y);
    return first_invocation + group * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
}
