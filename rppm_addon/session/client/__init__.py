# SPDX-License-Identifier: GPL-3.0-or-later
"""The renderer's process as its clients see it: started, connected, and asked for pictures."""
