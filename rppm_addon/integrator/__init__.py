# SPDX-License-Identifier: GPL-3.0-or-later
"""Rasterization-based progressive photon mapping on the device: Algorithm 1 and what it works with."""
