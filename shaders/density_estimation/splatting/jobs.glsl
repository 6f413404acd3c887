// SPDX-License-Identifier: GPL-3.0-or-later
// Splat jobs: a photon and the pixels [low, high) of the view that its sphere may reach. The buffer
// starts with the arguments of the indirect draw, six vertices a job.

struct SplatJob {
    uint photon;
    uint low;
    uint high;
    uint face;
};
