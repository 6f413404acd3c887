# SPDX-License-Identifier: GPL-3.0-or-later
"""Options of the rppm program, and what follows from them."""
