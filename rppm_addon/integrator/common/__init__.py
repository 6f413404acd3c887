# SPDX-License-Identifier: GPL-3.0-or-later
"""Code that all packages of the integrator share: records, iterations, bands of rows, lists of paths."""
