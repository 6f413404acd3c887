# SPDX-License-Identifier: GPL-3.0-or-later
"""First pictures: what is shown and rendered until the programs of a scene are compiled."""
