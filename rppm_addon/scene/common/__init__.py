# SPDX-License-Identifier: GPL-3.0-or-later
"""Declarations of members, and small tools for files, quantities and garbage collection that all layers use."""
