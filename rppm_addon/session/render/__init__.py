# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders from a scene to its pictures: the loop, its limits, passes and denoising."""
