# SPDX-License-Identifier: GPL-3.0-or-later
"""The type of the function by which sessions send messages to Blender."""

from collections.abc import Callable

Send = Callable[..., None]
"""send(kind, **content): send a message about the session to Blender. Raises BrokenPipeError when Blender has left."""
