# SPDX-License-Identifier: GPL-3.0-or-later
"""Functions for workers, which the scheduler reads too: either may have no RPPM.

They are made inside others, so that dask sends their code instead of their names, import late, and take plain values.
"""

from collections.abc import Callable
from pathlib import Path
from typing import Any


def identity_function(local: bool) -> Callable[[], str]:
    """Tells which RPPM a worker has, with ImportError where it has none.

    Args:
        local: the worker belongs to the farm alone. Ctrl-C at their terminal is for the farm, not for the worker.
    """

    def worker_identity() -> str:
        import signal

        from rppm_addon.commands.farm import worker  # noqa: F401 (that it can be imported is what is asked)
        from rppm_addon.commands.farm.identity import identity

        if local:
            signal.signal(signal.SIGINT, signal.SIG_IGN)
        return identity()

    return worker_identity


def perform_function() -> Callable:
    """worker.perform on the Task of these fields."""

    def perform_task(folder: Path, **fields: Any) -> object:
        from rppm_addon.commands.farm.tasks import Task
        from rppm_addon.commands.farm.worker import perform

        return perform(Task(**fields), folder)

    return perform_task
