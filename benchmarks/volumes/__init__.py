# SPDX-License-Identifier: GPL-3.0-or-later
"""Estimators of light in volumes, compared on analytic scenes at equal time."""
