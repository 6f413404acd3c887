# SPDX-License-Identifier: GPL-3.0-or-later
"""Direct light at the vertices of camera paths, by shadow rays, and the shadows that catchers receive."""
