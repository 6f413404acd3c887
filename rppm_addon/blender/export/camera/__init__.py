# SPDX-License-Identifier: GPL-3.0-or-later
"""Cameras, lenses and the view of a viewport."""
