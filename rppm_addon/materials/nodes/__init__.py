# SPDX-License-Identifier: GPL-3.0-or-later
"""Kinds of nodes, a module a family: each has ``KINDS``, a NodeKind by name."""
