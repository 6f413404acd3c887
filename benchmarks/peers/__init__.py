# SPDX-License-Identifier: GPL-3.0-or-later
"""RPPM beside other renderers at equal wall time; run.py is where to begin."""
