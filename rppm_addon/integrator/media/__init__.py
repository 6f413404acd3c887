# SPDX-License-Identifier: GPL-3.0-or-later
"""Volumes that camera paths and photons begin in."""
