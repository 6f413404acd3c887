# SPDX-License-Identifier: GPL-3.0-or-later
"""Light from its source to its end: closed forms, balances and bounces."""
