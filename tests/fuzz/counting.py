# SPDX-License-Identifier: GPL-3.0-or-later
"""Expectations of every way in: input is taken, or refused by the error that the way promises."""

import contextlib
import functools
import os
import signal
from collections.abc import Callable, Iterator

import hypothesis

EXAMPLES = int(os.environ.get("RPPM_FUZZ_EXAMPLES", "0"))
"""Number of examples of each way in; 0 is a few, always the same, as in the tests."""
_settings = hypothesis.settings(
    **({"max_examples": EXAMPLES} if EXAMPLES else {"max_examples": 40, "derandomize": True, "database": None}),
    deadline=None,  # which would count what other processes take
    suppress_health_check=list(hypothesis.HealthCheck),
    print_blob=True,
    phases=[phase for phase in hypothesis.Phase if phase is not hypothesis.Phase.explain],
)
LIMITS = {"ITIMER_PROF": ("SIGPROF", 10.0), "ITIMER_REAL": ("SIGALRM", 120.0)}
"""Seconds after which a case hangs: of the processor, and of waiting for what does not come."""
COUNTS: dict[str, list[int]] = {}
"""Cases given and cases refused by the name of a way in."""


class HangError(AssertionError):
    """A case takes longer than it may."""


def fuzzed(test: Callable) -> Callable:
    """A test that hypothesis gives its cases, each within LIMITS."""
    handle = test.hypothesis
    handle.inner_test = _within_limits(handle.inner_test)
    return _settings(test)


def _within_limits(case: Callable) -> Callable:
    @functools.wraps(case)
    def limited(*arguments: object, **named: object) -> None:
        def end(number: int, _: object) -> None:
            raise HangError(f"{case.__name__} hangs: {signal.Signals(number).name}")

        before = {name: signal.signal(getattr(signal, name), end) for name, _ in LIMITS.values()}
        try:
            for timer, (_, seconds) in LIMITS.items():
                signal.setitimer(getattr(signal, timer), seconds)
            case(*arguments, **named)
        finally:
            for timer in LIMITS:
                signal.setitimer(getattr(signal, timer), 0.0)
            for name, handler in before.items():
                signal.signal(getattr(signal, name), handler)

    return limited


@contextlib.contextmanager
def may_refuse(way: str, *errors: type[Exception]) -> Iterator[None]:
    """Count a case; of errors only these may come, and with words."""
    count = COUNTS.setdefault(way, [0, 0])
    count[0] += 1
    try:
        yield
    except errors as error:
        assert str(error).strip(), type(error)
        count[1] += 1
