# SPDX-License-Identifier: GPL-3.0-or-later
"""One module a renderer. Each runs as a program in its renderer's environment, which has NumPy and little else."""
