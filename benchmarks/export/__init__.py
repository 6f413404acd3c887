# SPDX-License-Identifier: GPL-3.0-or-later
"""Cost of a frame in which everything moves."""
