# SPDX-License-Identifier: GPL-3.0-or-later
"""Kinds and status of sessions in the renderer's process, which both sides know."""

import enum
from dataclasses import dataclass, field


class SessionKind(enum.Enum):
    """Purpose of a session; the value is its weight when several share the device."""

    PREPARATION = 0.25
    VIEWPORT = 1
    FINAL = 3
    PREVIEW = 4


@dataclass(frozen=True)
class SessionStatus:
    """How a session gets on."""

    generation: int = 0
    """Generation of the scene that the status is about."""
    program: str = ""
    """The name of the last that is being compiled."""
    programs_started: int = 0
    """Until the first iteration: programs that are compiled."""
    programs: int = 0
    """And those that are known to be needed."""
    programs_stood_in_for: int = 0
    """Programs of materials that are compiled while stand-ins are rendered in their place."""
    iteration: int = 0
    iterations: int = 0
    photons: int = 0
    elapsed_seconds: float = 0.0
    """Since the scene was taken up."""
    radius_meters: float = 0.0
    """r_max of the iteration."""
    memory_bytes: int = 0
    density_estimation: str = ""
    """As RenderStatistics has it."""
    first_photon_hits: str = ""
    """As RenderStatistics has it."""
    iterations_per_second: float = 0.0
    photons_per_second: float = 0.0
    noise: float = 0.0
    """As Progress has it."""
    noise_threshold: float = 0.0
    source_watts: dict[str, float] = field(default_factory=dict)
    """As RenderStatistics has it."""
    source_photons: dict[str, int] = field(default_factory=dict)
    warnings: list[str] = field(default_factory=list)
    error: str = ""
    """One line with the remedy; empty while all is well."""
    settled: bool = False
    """Whether nothing more will come until another scene is shown."""
