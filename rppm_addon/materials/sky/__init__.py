# SPDX-License-Identifier: GPL-3.0-or-later
"""Skies of the Sky Texture node: the models of Preetham, Hosek and Wilkie, and scattering."""
