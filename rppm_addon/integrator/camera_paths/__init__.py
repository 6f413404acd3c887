# SPDX-License-Identifier: GPL-3.0-or-later
"""The camera side of an iteration: first hits, importons, final gather, and walks below surfaces."""
