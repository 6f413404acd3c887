# SPDX-License-Identifier: GPL-3.0-or-later
"""Acceleration structures that rays are traced through: the interface of all of them."""
