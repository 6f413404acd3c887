// SPDX-License-Identifier: GPL-3.0-or-later
// Index of this thread when a one-dimensional dispatch is folded into rows of groups.

uint invocation_index() {
    return gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x + gl_GlobalInvocationID.x;
}
