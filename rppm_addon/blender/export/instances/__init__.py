# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects, what multiplies them, and where they are."""
