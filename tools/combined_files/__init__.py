# SPDX-License-Identifier: GPL-3.0-or-later
"""Random .blend files that combine features as published ones do: ``python -m tools.combined_files FOLDER``."""
