# SPDX-License-Identifier: GPL-3.0-or-later
"""Plain surfaces that are rendered in place of materials until their programs are compiled."""
