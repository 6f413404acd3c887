# SPDX-License-Identifier: GPL-3.0-or-later
"""The stages of Algorithm 1, a module each, with their buffers."""
