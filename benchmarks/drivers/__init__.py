# SPDX-License-Identifier: GPL-3.0-or-later
"""Every program compiled by the drivers of GPUs that are not there: ``make drivers``."""
