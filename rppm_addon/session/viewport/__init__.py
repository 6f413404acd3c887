# SPDX-License-Identifier: GPL-3.0-or-later
"""A viewport's session in the renderer's process."""
