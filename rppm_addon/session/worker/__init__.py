# SPDX-License-Identifier: GPL-3.0-or-later
"""The renderer's process: its sessions, and whose turn on the device it is."""
