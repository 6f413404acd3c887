# SPDX-License-Identifier: GPL-3.0-or-later
"""Values of phase functions, for tests."""
