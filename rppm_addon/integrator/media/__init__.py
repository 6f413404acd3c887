# SPDX-License-Identifier: GPL-3.0-or-later
"""Participating media: those that paths begin in, and the light that they scatter."""
