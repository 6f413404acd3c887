# SPDX-License-Identifier: GPL-3.0-or-later
"""What is expected of every way in: what is given is taken, or refused by the error that the way promises."""

import contextlib
import os
from collections.abc import Iterator

import hypothesis

EXAMPLES = int(os.environ.get("RPPM_FUZZ_EXAMPLES", "0"))
"""Of each way; 0 is a few, always the same, as in the tests."""
fuzzed = hypothesis.settings(
    **({"max_examples": EXAMPLES} if EXAMPLES else {"max_examples": 40, "derandomize": True, "database": None}),
    deadline=10_000,  # milliseconds: what takes longer hangs
    suppress_health_check=list(hypothesis.HealthCheck),
    print_blob=True,
    phases=[phase for phase in hypothesis.Phase if phase is not hypothesis.Phase.explain],
)
COUNTS: dict[str, list[int]] = {}
"""Cases given and cases refused by the name of a way in."""


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
