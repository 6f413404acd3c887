# SPDX-License-Identifier: GPL-3.0-or-later
"""Lights, what sees them, and what they leave out."""
