# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables and plots of the figures."""
