# SPDX-License-Identifier: GPL-3.0-or-later
"""Records that come from the other process, held to their declarations."""

from typing import Any, TypeVar

from ...scene.errors import SceneError
from ...scene.storage.validation import check_record
from .protocol import ProtocolError

_Record = TypeVar("_Record")


def received(kind: type[_Record], values: dict[str, Any]) -> _Record:
    """A dataclass of plain values, which may be any numbers. Raises ProtocolError for what is none of its kind."""
    try:
        record = kind(**values)
        check_record(record, kind)
    except (SceneError, TypeError) as error:
        raise ProtocolError(f"no {kind.__name__} came ({error})") from error
    return record
