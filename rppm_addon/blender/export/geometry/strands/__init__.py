# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair curves, hair of particle systems and point clouds to triangles."""
