# SPDX-License-Identifier: GPL-3.0-or-later
"""All rows, in the order of docs/compatibility.md: importing the families puts them on the list."""

# isort: off
from .surfaces import ashikhmin_shirley  # noqa: F401
from .shapes import cameras  # noqa: F401
from .values import coordinates  # noqa: F401
from .shapes import displacement  # noqa: F401
from .surfaces import fibers  # noqa: F401
from .lighting import light_limits, light_linking, light_paths, lights  # noqa: F401
from .surfaces import media, metallic  # noqa: F401
from .lighting import portals, profiles  # noqa: F401
from .surfaces import ray_nodes, ray_portals, shaders  # noqa: F401
from .lighting import shadow_terminator  # noqa: F401
from .shapes import simplify  # noqa: F401
from .values import nodes, zones_and_closures  # noqa: F401
from .values import working_spaces  # noqa: F401

# isort: on
from .rows import ROWS

__all__ = ["ROWS"]
