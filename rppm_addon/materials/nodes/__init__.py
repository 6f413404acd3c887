# SPDX-License-Identifier: GPL-3.0-or-later
"""Registries of the kinds of nodes, one module per family: ``KINDS``, by name."""
