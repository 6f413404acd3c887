# SPDX-License-Identifier: GPL-3.0-or-later
"""Values and closures of shader nodes, sample by sample."""
