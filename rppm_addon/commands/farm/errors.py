# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of a farm."""

from ...scene.errors import RppmError


class FarmError(RppmError):
    """The farm cannot do what is asked."""


class TaskError(RppmError):
    """One task has failed. Travels from the worker to the farm, so that all it holds are plain values."""

    def __init__(self, text: str, worker: str) -> None:
        super().__init__(text, worker)
        self.text = text
        """Error message of the program, or how the program ended."""
        self.worker = worker

    def __str__(self) -> str:
        return self.text
