# SPDX-License-Identifier: GPL-3.0-or-later
"""Checkpoints: renders that are written while they run and continued later."""
