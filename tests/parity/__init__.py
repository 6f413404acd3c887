# SPDX-License-Identifier: GPL-3.0-or-later
"""RPPM against Cycles and closed forms, in scenes that isolate one thing each."""
