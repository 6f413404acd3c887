// SPDX-License-Identifier: GPL-3.0-or-later
// The limits of bounces by type.
#include "common/iteration.glsl"
#include "common/bounce_counts.glsl"

bool exceed_limits(uvec4 counts) { return any(greaterThan(counts, iteration.bounce_limits)); }
