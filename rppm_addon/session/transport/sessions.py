# SPDX-License-Identifier: GPL-3.0-or-later
"""Kinds and status of sessions in the renderer's process, for both sides of the connection."""

import enum
from dataclasses import dataclass, field

from ..render.results import PhotonStatistics, Progress


class SessionKind(enum.Enum):
    """Purpose of a session; the value is its weight when several render at once."""

    PREPARATION = 0.25
    VIEWPORT = 1
    FINAL = 3
    PREVIEW = 4


@dataclass(frozen=True)
class CompilationProgress:
    """Progress of the programs of a viewport."""

    fraction: float | None = None
    """Fraction of the work before the first iteration that is done, 0 to 1; None before any is known."""
    stood_in_for: int = 0
    """Programs of materials that are compiled while stand-ins are rendered in their place."""


@dataclass(frozen=True)
class SessionStatus:
    """Status of a viewport's session."""

    generation: int = 0
    """Generation of the scene that the status is about."""
    compilation: CompilationProgress = field(default_factory=CompilationProgress)
    progress: Progress | None = None
    """Progress since the scene was received; None before the first iteration."""
    photon_statistics: PhotonStatistics = field(default_factory=PhotonStatistics)
    warnings: list[str] = field(default_factory=list)
    error: str = ""
    """One line with the remedy; empty while all is well."""
    settled: bool = False
    """Whether nothing more will come until another scene is shown."""

    @property
    def iteration(self) -> int:
        """Number of complete iterations."""
        return 0 if self.progress is None else self.progress.iteration
