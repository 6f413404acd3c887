# SPDX-License-Identifier: GPL-3.0-or-later
"""The terminal: progress, texts, and interruption."""
