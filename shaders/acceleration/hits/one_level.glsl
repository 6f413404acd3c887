// SPDX-License-Identifier: GPL-3.0-or-later
// The instance of a hit where all triangles lie in the world. The includer declares the block Attributes before.

uint instance_of(uint triangle) { return attributes[triangle].instance; }
