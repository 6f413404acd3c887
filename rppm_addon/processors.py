# SPDX-License-Identifier: GPL-3.0-or-later
"""The processors of this machine."""

import os


def usable_cores() -> int:
    """Processor cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
