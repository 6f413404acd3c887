# SPDX-License-Identifier: GPL-3.0-or-later
"""GLSL sources: includes, records, defines, and line numbers that name our files."""

import functools
import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

from ..buffers.constants import Constants
from ..buffers.records import Record
from ..buffers.storage_blocks import StorageBlock
from ..buffers.texel_buffers import TexelBuffer
from .bindings import BLOCK_LAYOUT, ITERATION, number_bindings, number_images, numbered_blocks, numbered_textures
from .functions import put_together
from .texel_sources import declared_texel_buffers, read_as_texels

_PACKAGE = Path(__file__).resolve().parents[2]
SHADER_FOLDER = next(folder for folder in (_PACKAGE / "shaders", _PACKAGE.parent / "shaders") if folder.is_dir())
"""In the package where pip installed it, else beside it: in a checkout and in Blender's extension."""

_INCLUDE = re.compile(r'^\s*#\s*include\s+(?:"([^"]+)"|<(\w+)>|([A-Z_]+)(?:\s+"([^"]+)")?)\s*$')
_VERSION = re.compile(r"^\s*#\s*version\b")
_BLOCK = re.compile(r"^((?:\w+\s+)*buffer\s+(\w+))\s*([;{].*)$")
_PARAMETERS = re.compile(r"\buniform\s+Parameters\s*\{\s*(\w+)\s+\w+\s*;")
_ITERATION = re.compile(rf"\buniform\s+{ITERATION}\b")
_LOCAL_SIZE = re.compile(r"local_size_x\s*=\s*(\d+)")
# "0:12(3): error" (Mesa), "0(12) : error" (NVIDIA), "ERROR: 0:12:" (AMD, Intel, glslang)
_POSITION = re.compile(r"\b(\d+)(?::|\()(\d+)\b\)?")


class ShaderError(Exception):
    """A shader is wrong: a missing include or a compile error, by our file names and lines."""


class CompileError(ShaderError):
    """The driver does not compile or link a shader."""


@dataclass
class Source:
    """An expanded shader: its text and the files that its #line numbers stand for."""

    text: str
    files: list[str]
    texel_buffers: dict[str, TexelBuffer] = field(default_factory=dict)
    """By the names of the blocks that they stand for."""

    @property
    def suffix(self) -> str:
        """Suffix of the file's name, which says which stage it is."""
        return Path(self.files[0]).suffix

    @property
    def blocks(self) -> dict[str, int]:
        """Binding of each storage block by the block's name, but for those that are texel buffers here."""
        return {name: number for name, number in numbered_blocks(self.text).items() if name not in self.texel_buffers}

    @property
    def textures(self) -> dict[str, int]:
        """Unit of each texture by the name of its sampler."""
        return numbered_textures(self.text)

    @property
    def parameters(self) -> Record | None:
        """The record of the parameter block, if there is one."""
        match = _PARAMETERS.search(self.text)
        return Record.registry[match.group(1)] if match else None

    @property
    def reads_iteration(self) -> bool:
        """Presence of the uniform block Iteration in the source."""
        return _ITERATION.search(self.text) is not None

    @property
    def local_size(self) -> int:
        """Invocations of a work group. Raises ShaderError when the source says none."""
        match = _LOCAL_SIZE.search(self.text)
        if match is None:
            raise ShaderError(f"{self.files[0]}: no local_size_x; declare layout(local_size_x = 64) in")
        return int(match.group(1))

    def name_lines(self, message: str) -> str:
        """A driver's message with file numbers replaced by file names."""

        def name(match: re.Match) -> str:
            number = int(match.group(1))
            return f"{self.files[number]}:{match.group(2)}" if number < len(self.files) else match.group(0)

        return "\n".join(_POSITION.sub(name, line, count=1) for line in message.splitlines())


def expand(
    path: str,
    defines: dict[str, object] | None = None,
    inserts: dict[str, str] | None = None,
    reads_texels: bool = False,
    large: Collection[str] = (),
    whole: bool = False,
    beside: Source | None = None,
) -> Source:
    """Read a shader below the shader folder and resolve its includes.

    ``#include "common/x.glsl"`` inserts a file once; ``#include TRAVERSAL`` inserts the file that the define of that
    name is; ``#include EMITTERS "lights/one_level/tree.glsl"`` this file, or the one of its name in the folder that
    the define is, where there is one; ``#include <Ray>`` inserts the struct of the record, or the constants, of that
    name once; ``readonly buffer Rays;`` gets the members of the StorageBlock of that name, and before it the
    structs of its records. Blocks, textures and images get numbers (bindings.py). Defines go after #version;
    ``inserts`` are texts of files that are made at run time, by name. reads_texels: blocks that are only read become
    texel buffers; large: those of these names in any case (read_as_texels). Sources with either have READS_TEXELS
    defined. Functions that main does not lead to are left out, unless it is to be whole. beside: the other stage of the
    program, whose numbers hold here as well.
    Raises ShaderError.
    """
    defines = {**(defines or {}), **({"READS_TEXELS": 1} if reads_texels or large else {})}
    expansion = _Expansion(defines, inserts or {})
    expansion.read(path, path)
    text = number_images(put_together(expansion.lines, whole) + "\n")
    texel_buffers = declared_texel_buffers(text, defines)
    if reads_texels or large:
        text, texel_buffers = read_as_texels(text, texel_buffers, large, reads_texels)
    numbers = (beside.blocks, beside.textures) if beside else ({}, {})
    return Source(number_bindings(text, *numbers), expansion.files, texel_buffers)


class _Expansion:
    """The lines of a shader, and the files that they are from."""

    def __init__(self, defines: Mapping[str, object], inserts: Mapping[str, str]) -> None:
        self.files: list[str] = []
        self.lines: list[str] = []
        self._defines, self._inserts = defines, inserts
        self._declared: dict[str, Record | Constants] = {**Record.registry, **Constants.registry}
        self._seen: set[str] = set()

    def read(self, name: str, includer: str) -> None:
        """Add a file, unless it is there. Raises ShaderError."""
        if name in self.files:
            return
        try:
            text = self._inserts.get(name) or _text_of_file(str(SHADER_FOLDER / name))
        except OSError as error:
            problem = f"cannot include {name}" if self.files else "there is no such file below shaders/"
            raise ShaderError(f"{includer}: {problem} ({error.strerror})") from error
        number = len(self.files)
        self.files.append(name)
        if number:
            self.lines.append(f"#line 1 {number}")
        for line_number, line, match in _parts(text):
            place = f"{name}:{line_number}"
            if match is None:
                self.lines.append(line)
            elif match.re is _VERSION:
                self.lines.append(line)
                self.lines.extend(f"#define {key} {value}" for key, value in self._defines.items())
                self.lines.append(f"#line {line_number + 1} {number}")
            elif match.re is _BLOCK:
                self.lines.append(self._block(match[1], match[2], match[3], place))
            elif not match[2]:
                self.read(_included_file(match, self._defines, place), place)
                self.lines.append(f"#line {line_number + 1} {number}")
            elif match[2] in self._declared:
                self.lines.append(self._declare(match[2]))
            else:
                raise ShaderError(
                    f"{place}: {match[2]} is neither a Record nor Constants; declare it in a module that is imported"
                )

    def _declare(self, name: str) -> str:
        """GLSL of a record, after those that it consists of, or of constants; empty where it is there."""
        if name in self._seen:
            return ""
        self._seen.add(name)
        found = self._declared[name]
        parts = [self._declare(part.name) for part in found.parts] if isinstance(found, Record) else []
        return " ".join([*filter(None, parts), found.glsl()])

    def _block(self, declaration: str, name: str, rest: str, place: str) -> str:
        """GLSL of a storage block with its layout, and with its members where ``rest`` begins with no brace."""
        if not rest.startswith(";"):
            return f"{BLOCK_LAYOUT} {declaration} {rest}"
        if name not in StorageBlock.registry:
            raise ShaderError(
                f"{place}: there is no storage block {name}; declare it as a StorageBlock, or give its members here"
            )
        shared = StorageBlock.registry[name]
        structs = "".join(f"{self._declare(record.name)} " for record in shared.records)
        return f"{structs}{BLOCK_LAYOUT} {declaration} {{ {shared.members} }}{rest}"


def _included_file(match: re.Match, defines: Mapping[str, object], includer: str) -> str:
    """The file that an #include names, itself or by a define. Raises ShaderError where there is no such define."""
    if match.group(1):
        return str(match.group(1))
    define, other = match.group(3), match.group(4)
    if define not in defines:
        if not other:
            raise ShaderError(f"{includer}: {define} is not defined")
        return str(other)
    return f"{defines[define]}/{PurePosixPath(other).name}" if other else str(defines[define])


def _text_of_file(path: str) -> str:
    """Text of a file, the same object until the file changes. Raises OSError."""
    return _read_file(path, Path(path).stat().st_mtime_ns)


@functools.lru_cache(maxsize=512)
def _read_file(path: str, _modified: int) -> str:
    return Path(path).read_text(encoding="utf-8")


@functools.lru_cache(maxsize=512)
def _parts(text: str) -> list[tuple[int, str, re.Match | None]]:
    """A file's lines by their numbers, with what those match that are to be replaced; others that follow each other
    together. Most files are included by many."""
    parts: list[tuple[int, str, re.Match | None]] = []
    plain: list[str] = []
    for number, line in enumerate(text.splitlines(), 1):
        match = _INCLUDE.match(line) or _VERSION.match(line) or ("buffer" in line and _BLOCK.match(line)) or None
        if match is None:
            plain.append(line)
            continue
        if plain:
            parts.append((number - len(plain), "\n".join(plain), None))
        plain = []
        parts.append((number, line, match))
    if plain:
        parts.append((0, "\n".join(plain), None))
    return parts
