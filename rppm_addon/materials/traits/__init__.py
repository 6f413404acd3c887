# SPDX-License-Identifier: GPL-3.0-or-later
"""Traits of node graphs: what a graph emits, transmits and scatters, found without evaluating it."""
