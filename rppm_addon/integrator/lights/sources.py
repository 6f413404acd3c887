# SPDX-License-Identifier: GPL-3.0-or-later
"""Names of light sources in statistics."""

SURFACES = "Emissive surfaces"
ENVIRONMENT = "World"


def source_name(light: str) -> str:
    """Of a light object, never that of the surfaces or the world."""
    return f'Light "{light}"'
