# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes of many instances: memory and processor time beside Cycles, and what moving one of them costs."""
