# SPDX-License-Identifier: GPL-3.0-or-later
"""The renderer's process: client, server, and what goes between them."""
