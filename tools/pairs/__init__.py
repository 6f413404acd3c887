# SPDX-License-Identifier: GPL-3.0-or-later
"""The program that renders .blend files with RPPM and with Cycles, side by side: ``python -m tools.pairs FOLDER``."""
