# SPDX-License-Identifier: GPL-3.0-or-later
"""Participating media against Cycles."""
