// SPDX-License-Identifier: GPL-3.0-or-later
// Index of this thread when a one-dimensional dispatch is folded into rows of groups, or cut into pieces.

layout(location = 0) uniform uint first_invocation;  // of the piece (gl/context/pacing.py)

uint invocation_index() {
    return first_invocation + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x
           + gl_GlobalInvocationID.x;
}
