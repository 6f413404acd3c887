# SPDX-License-Identifier: GPL-3.0-or-later
"""The view layer: settings, passes, visibility, masks, and light linking."""
