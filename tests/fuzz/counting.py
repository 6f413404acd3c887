# SPDX-License-Identifier: GPL-3.0-or-later
"""What is expected of every way in: what is given is taken, or refused by the error that the way promises."""

import contextlib
from collections.abc import Iterator

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
