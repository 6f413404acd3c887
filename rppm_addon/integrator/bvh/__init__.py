# SPDX-License-Identifier: GPL-3.0-or-later
"""BVH: rays through a bounding volume hierarchy."""
