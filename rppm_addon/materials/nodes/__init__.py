# SPDX-License-Identifier: GPL-3.0-or-later
"""Kinds of nodes, by family."""
