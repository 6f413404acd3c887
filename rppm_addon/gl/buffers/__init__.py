# SPDX-License-Identifier: GPL-3.0-or-later
"""Records, constants and storage blocks that Python and GLSL share, and the buffers that hold them."""
