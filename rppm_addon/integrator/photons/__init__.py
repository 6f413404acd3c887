# SPDX-License-Identifier: GPL-3.0-or-later
"""The photon side of an iteration: emission, first hits, and photon paths."""
