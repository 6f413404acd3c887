# SPDX-License-Identifier: GPL-3.0-or-later
"""Predicted cost of every program of an iteration on a GPU, before there is one."""
