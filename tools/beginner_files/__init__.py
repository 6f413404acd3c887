# SPDX-License-Identifier: GPL-3.0-or-later
"""Small .blend files as beginners make them, for tools/pairs: ``python -m tools.beginner_files FOLDER``."""
