# SPDX-License-Identifier: GPL-3.0-or-later
"""OpenGL: the context, programs, records and buffers."""
