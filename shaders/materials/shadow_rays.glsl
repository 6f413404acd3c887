// SPDX-License-Identifier: GPL-3.0-or-later
// Before the nodes of a material that ask whether a ray is a shadow ray: light that comes straight from its source
// passes such a surface by the answer to shadow rays.
#define ASKS_FOR_SHADOW_RAYS
