# SPDX-License-Identifier: GPL-3.0-or-later
"""Lights on the device: their table, how one is chosen, and where their photons are sent."""
