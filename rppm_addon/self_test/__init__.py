# SPDX-License-Identifier: GPL-3.0-or-later
"""Tries a device: whether what RPPM computes on it is right, and how long that takes."""
