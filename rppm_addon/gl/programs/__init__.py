# SPDX-License-Identifier: GPL-3.0-or-later
"""Programs: GLSL sources, bindings, compiling, linking and the cache of binaries."""
