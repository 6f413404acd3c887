# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures that a viewport shows of few pixels and samples, and while its view moves."""
