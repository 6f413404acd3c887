# SPDX-License-Identifier: GPL-3.0-or-later
"""Limits of a render: samples, time and noise."""
