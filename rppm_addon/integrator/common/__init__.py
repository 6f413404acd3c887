# SPDX-License-Identifier: GPL-3.0-or-later
"""What all rooms of the integrator share: records, iterations, bands of rows, lists of paths."""
