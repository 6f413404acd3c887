# SPDX-License-Identifier: GPL-3.0-or-later
"""What a viewport shows of few pixels and samples, and while its view moves."""
