#version 430 core
// SPDX-License-Identifier: GPL-3.0-or-later
// Where paths begin, all of them are listed.

layout(local_size_x = 64) in;

#include <CountParameters>
#include "common/invocation.glsl"
uniform Parameters { CountParameters parameters; };
buffer KeptPaths;

void main() {
    uint index = invocation_index();
    if (index < parameters.count) kept_paths[index] = index;
}
