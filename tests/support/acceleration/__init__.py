# SPDX-License-Identifier: GPL-3.0-or-later
"""Hierarchies of boxes, for tests."""
