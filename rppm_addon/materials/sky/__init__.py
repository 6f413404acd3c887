# SPDX-License-Identifier: GPL-3.0-or-later
"""What the Sky Texture node shows: the models of Preetham, Hosek and Wilkie, and scattering."""
