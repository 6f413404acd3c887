// SPDX-License-Identifier: GPL-3.0-or-later
// What jobs, fragments, entries name: a triangle, or, in scenes of many, a cluster of 2^k triangles that follow each
// other and lie together, as first triangle << 2 | k. Rays test all of them, so hits are the same.

#ifdef TRIANGLE_CLUSTERS
uint pack_cluster(uint first, uint size) { return first << 2 | uint(findMSB(size)); }
uint cluster_first(uint cluster) { return cluster >> 2; }
uint cluster_size(uint cluster) { return 1u << (cluster & 3u); }
#else
uint cluster_first(uint cluster) { return cluster; }
uint cluster_size(uint cluster) { return 1u; }
#endif
