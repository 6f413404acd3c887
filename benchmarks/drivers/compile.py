# SPDX-License-Identifier: GPL-3.0-or-later
"""Compiles programs on the driver that this process gets: ``python compile.py PROGRAMS.json RESULTS.json``.

It needs moderngl alone, as it also runs inside a chroot. Each program is dispatched or drawn once, where drivers that
compile late do it. Before each, ``MARK`` and its number go to stderr, where drivers print what they make of it.
"""

import ctypes
import json
import sys
import time
from pathlib import Path

import moderngl

MARK = "@@ "
_ANY = 0x1100
_DEBUG_OUTPUT, _DEBUG_OUTPUT_SYNCHRONOUS = 0x92E0, 0x8242
_SHADER_COMPILER = 0x8248
_LIMITS = (
    "GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS",
    "GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS",
    "GL_MAX_VERTEX_SHADER_STORAGE_BLOCKS",
    "GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS",
    "GL_MAX_SHADER_STORAGE_BLOCK_SIZE",
    "GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS",
    "GL_MAX_COMPUTE_SHARED_MEMORY_SIZE",
    "GL_MAX_TEXTURE_SIZE",
    "GL_MAX_TEXTURE_BUFFER_SIZE",
    "GL_MAX_COMBINED_SHADER_OUTPUT_RESOURCES",
)
_unsigned = ctypes.c_uint
_CALLBACK = ctypes.CFUNCTYPE(
    None, _unsigned, _unsigned, _unsigned, _unsigned, ctypes.c_int, ctypes.c_char_p, ctypes.c_void_p
)


def _function(name: str, *arguments: type) -> ctypes._CFuncPtr:
    egl = ctypes.CDLL("libEGL.so.1")
    egl.eglGetProcAddress.restype = ctypes.c_void_p
    egl.eglGetProcAddress.argtypes = [ctypes.c_char_p]
    return ctypes.CFUNCTYPE(None, *arguments)(egl.eglGetProcAddress(name.encode()))


def listen(messages: list[str]) -> ctypes._CFuncPtr:
    """Have the driver's compiler add what it says to a list, as long as what is returned lives."""

    def add(source: int, kind: int, number: int, severity: int, length: int, text: bytes, _: object) -> None:
        if source == _SHADER_COMPILER:
            messages.append(text[:length].decode(errors="replace").strip())

    callback = _CALLBACK(add)
    control = (_unsigned, _unsigned, _unsigned, ctypes.c_int, ctypes.c_void_p, ctypes.c_ubyte)
    _function("glDebugMessageCallback", _CALLBACK, ctypes.c_void_p)(callback, None)
    _function("glDebugMessageControl", *control)(_ANY, _ANY, _ANY, 0, None, 1)
    for capability in (_DEBUG_OUTPUT, _DEBUG_OUTPUT_SYNCHRONOUS):
        _function("glEnable", _unsigned)(capability)
    return callback


def compile_program(gl: moderngl.Context, stages: dict[str, str]) -> None:
    """Compile, link and run it once. Raises moderngl.Error."""
    if "comp" in stages:
        program = gl.compute_shader(stages["comp"])
        program.run(1)
    else:
        program = gl.program(vertex_shader=stages["vert"], fragment_shader=stages["frag"])
        gl.simple_framebuffer((16, 16)).use()
        gl.vertex_array(program, []).render(moderngl.TRIANGLES, vertices=3)
    gl.finish()
    if gl.error != "GL_NO_ERROR":
        raise moderngl.Error("OpenGL has an error after its first run")


def main(programs: str, results: str) -> None:
    """Write the driver's name, version, limits, and seconds, messages and error of each program."""
    gl = moderngl.create_context(standalone=True, require=430, backend="egl")
    messages: list[str] = []
    callback = listen(messages)
    rows = []
    wanted = json.loads(Path(programs).read_text(encoding="utf-8"))
    for number, stages in enumerate(wanted):
        print(f"\n{MARK}{number}", file=sys.stderr, flush=True)
        messages.clear()
        error = ""
        start = time.process_time()
        try:
            compile_program(gl, stages)
        except moderngl.Error as raised:
            error = str(raised)
        rows.append({"seconds": time.process_time() - start, "messages": list(messages), "error": error})
    del callback
    found = {
        "device": gl.info["GL_RENDERER"],
        "version": gl.info["GL_VERSION"],
        "limits": {name: gl.info[name] for name in _LIMITS if name in gl.info},
        "programs": rows,
    }
    Path(results).write_text(json.dumps(found), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
