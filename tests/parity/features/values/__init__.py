# SPDX-License-Identifier: GPL-3.0-or-later
"""Rows of values that nodes compute."""
