# SPDX-License-Identifier: GPL-3.0-or-later
"""Texts for terminals, which obey some of the letters that names may have."""

import logging


def printable(text: str) -> str:
    """The text with what is no letter, or cannot be written, as Python's escapes."""
    if text.isprintable():
        return text
    return "".join(
        letter if letter.isprintable() else letter.encode("unicode_escape", "surrogatepass").decode() for letter in text
    )


class LineFormatter(logging.Formatter):
    """Makes a line of each record, whatever the names in it; tracebacks stay as they are."""

    def formatMessage(self, record: logging.LogRecord) -> str:  # noqa: N802 (logging's own name)
        """As Formatter has it."""
        record.message = printable(record.message)
        return super().formatMessage(record)
