# SPDX-License-Identifier: GPL-3.0-or-later
"""Functions that run on workers which may have no RPPM: they travel by value and import late."""


def admit(local: bool) -> str:
    """Which RPPM this worker has; raises ImportError where it has none.

    Args:
        local: the worker belongs to the farm alone. Ctrl-C at their terminal is for the farm, not for the worker.
    """
    import signal

    from rppm_addon.commands.farm import worker  # noqa: F401 (that it can be imported is what is asked)
    from rppm_addon.commands.farm.identity import identity

    if local:
        signal.signal(signal.SIGINT, signal.SIG_IGN)
    return identity()
