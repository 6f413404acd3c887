# SPDX-License-Identifier: GPL-3.0-or-later
"""The render engine: final renders, viewports and baking."""
