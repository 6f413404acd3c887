# SPDX-License-Identifier: GPL-3.0-or-later
"""Resources that are held by a process that renders frame after frame: memory, files, threads, GL objects."""

import ctypes
import gc
import os
from pathlib import Path

from rppm_addon.gl.context.context import Context
from rppm_addon.session.render import renderer as session_renderer


def resident_bytes() -> int:
    """Memory of this process that is in use, as the kernel counts it, without what only waits to be used again."""
    gc.collect()
    if hasattr(_libc, "malloc_trim"):
        _libc.malloc_trim(0)
    lines = Path("/proc/self/status").read_text().splitlines()
    return next(int(line.split()[1]) << 10 for line in lines if line.startswith("VmRSS:"))


_libc = ctypes.CDLL(None)


def gl_objects(context: Context) -> dict[str, int]:
    """How many objects the driver has of each kind, this one's own aside. Names are given in ascending order."""
    gl = context.moderngl
    texture, buffer = gl.texture((1, 1), 1), gl.buffer(reserve=4)
    framebuffer = gl.framebuffer([texture])
    made = {"Texture": texture, "Buffer": buffer, "Framebuffer": framebuffer}
    counts = {}
    for kind, newest in made.items():
        is_one = context.function(f"glIs{kind}", ctypes.c_ubyte, ctypes.c_uint)
        counts[f"{kind.lower()}s"] = sum(is_one(name) for name in range(1, newest.glo))
    for resource in (framebuffer, texture, buffer):
        resource.release()
    return counts


class HeldByFrame:
    """While entered, notes after each render what is held, in ``frames``."""

    def __init__(self, every: int = 1) -> None:
        self._every = every
        self._count = 0
        self.frames: list[dict[str, int]] = []

    def __enter__(self) -> "HeldByFrame":
        self._original = original = session_renderer.Renderer.render

        def render(renderer, *arguments, **named):
            result = original(renderer, *arguments, **named)
            self._count += 1
            if self._count % self._every == 0:
                with renderer._context.moderngl:  # in the renderer's thread, where its context is
                    objects = gl_objects(renderer._context)
                counts = {"files": len(os.listdir("/proc/self/fd")), "threads": len(os.listdir("/proc/self/task"))}
                self.frames.append({"frame": self._count, "bytes": resident_bytes(), **counts, **objects})
            return result

        session_renderer.Renderer.render = render
        return self

    def __exit__(self, *_: object) -> None:
        session_renderer.Renderer.render = self._original
