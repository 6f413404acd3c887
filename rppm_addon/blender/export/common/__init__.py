# SPDX-License-Identifier: GPL-3.0-or-later
"""Matrices, random numbers, time slices and the report, which all rooms of the export use."""
