# SPDX-License-Identifier: GPL-3.0-or-later
"""Records that stages hand to each other. Lengths in meters, flux in W, radiance in W/(m^2 sr)."""
