# SPDX-License-Identifier: GPL-3.0-or-later
"""Records that come from the other process, held to their declarations."""

from typing import Any, TypeVar

from ...scene.errors import SceneError
from ...scene.storage.documents import decode
from ...scene.storage.validation import check_record
from .protocol import ProtocolError

_Record = TypeVar("_Record")


def received(kind: type[_Record], values: dict[str, Any]) -> _Record:
    """Return a dataclass of plain values, or of such dataclasses, that came with a message. Numbers may be any.

    Raises ProtocolError for values that do not fit the dataclass.
    """
    try:
        record = decode(values, kind, {})
        check_record(record, kind)
    except (SceneError, LookupError, TypeError, ValueError, AttributeError) as error:
        raise ProtocolError(f"no {kind.__name__} came ({error})") from error
    return record
