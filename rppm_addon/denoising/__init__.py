# SPDX-License-Identifier: GPL-3.0-or-later
"""Noise taken out of pictures by Intel's Open Image Denoise, between the film and whoever shows the picture."""
